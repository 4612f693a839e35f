#!/usr/bin/env python3
"""F4, P5: a node that works for long, with a subscriber that has stalled, takes no more memory than at first.
`rostest soft_tissue_sim soak.test seconds:=600` prints what it took over ten minutes."""
import os
import signal
import subprocess
import sys
import unittest
import xmlrpc.client

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import PointCloud2
from soft_tissue_sim.msg import SimulationStatus

from ros_world import resident_kilobytes

LISTENER = """
import rospy
from sensor_msgs.msg import PointCloud2
rospy.init_node("stalled", disable_signals=True)
rospy.Subscriber("/deformed_cloud", PointCloud2, lambda cloud: print("heard", flush=True))
rospy.spin()
"""


class Soak(unittest.TestCase):
    def test_memory_stays_as_it_is(self):
        rospy.init_node("soak")
        clouds, forces = [], []
        rospy.Subscriber("/deformed_cloud", PointCloud2, lambda cloud: clouds.append(cloud.width))
        rospy.Subscriber("/finger/servo_cf", WrenchStamped, lambda wrench: forces.append(wrench.wrench.force.z))
        # Tissue has been factorised and is moved.
        while not any(forces):
            rospy.rostime.wallsleep(0.1)
        deformer = xmlrpc.client.ServerProxy(rospy.get_master().lookupNode("/deformer_node")[2]).getPid("/soak")[2]
        stalled = subprocess.Popen([sys.executable, "-c", LISTENER], stdout=subprocess.PIPE)
        stalled.stdout.readline()
        stalled.send_signal(signal.SIGSTOP)
        try:
            for _ in range(5):
                rospy.wait_for_message("/deformer_node/status", SimulationStatus, timeout=60)
            poses, shown = len(forces), len(clouds)
            memory = []
            for _ in range(int(rospy.get_param("~seconds"))):
                rospy.rostime.wallsleep(1.0)
                memory.append(resident_kilobytes(deformer))
        finally:
            stalled.kill()
            stalled.wait()
        seconds = len(memory)
        slope = 60.0 * (memory[-1] - memory[0]) / seconds
        print(f"soak: {seconds} s, {len(forces) - poses} forces, {len(clouds) - shown} clouds of {clouds[-1]} vertices; "
              f"resident {memory[0]} kB at first, {min(memory)} to {max(memory)}, slope {slope:.0f} kB/min", flush=True)
        self.assertLess(max(memory) - memory[0], 5000)
        self.assertGreater(len(clouds) - shown, 5 * seconds)
        self.assertGreater(len(forces) - poses, 100 * seconds)
        os.kill(deformer, 0)


if __name__ == "__main__":
    rostest.rosrun("soft_tissue_sim", "soak", Soak)
