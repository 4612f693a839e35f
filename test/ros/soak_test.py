#!/usr/bin/env python3
"""F4, P5: a node that works for long under three tools, with a subscriber that has stalled and meshes that are built
and thrown away in between, takes no more memory than at first and answers as soon. scripts/soak: for ten minutes."""
import itertools
import os
import signal
import statistics
import subprocess
import sys
import time
import unittest
import xmlrpc.client

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import PointCloud2
from soft_tissue_sim.msg import Result, SimulationStatus
from soft_tissue_sim.srv import BuildMesh

from ros_world import figure, resident_kilobytes, wait_for

LISTENER = """
import rospy
from sensor_msgs.msg import PointCloud2
rospy.init_node("stalled", disable_signals=True)
rospy.Subscriber("/deformed_cloud", PointCloud2, lambda cloud: print("heard", flush=True))
rospy.spin()
"""


def slope(values):
    """Of the least-squares line through values that are one apart."""
    middle, mean = (len(values) - 1) / 2, sum(values) / len(values)
    return (sum((i - middle) * (value - mean) for i, value in enumerate(values)) /
            sum((i - middle) ** 2 for i in range(len(values))))


class Soak(unittest.TestCase):
    def build(self, size):
        """A mesh that the deformer has taken."""
        answer = self.mesher(use_mask=True, iso_value=20.0, initial_tetrahedra=size, level_sections=3, smooth_levels=2)
        self.assertEqual(answer.result.code, Result.OK, answer.result.message)
        wait_for(lambda: self.status and self.status.mesh_uuid != self.uuid, 60)
        self.uuid = self.status.mesh_uuid

    def settle(self):
        """Until all tools hold tissue: each that takes hold has it factorised anew."""
        quick = 0
        while quick < 10:
            status = rospy.wait_for_message("/deformer_node/status", SimulationStatus, timeout=60)
            holds = status.step_seconds < 0.1 and "TOOL_LOST" not in status.flags
            quick = quick + 1 if holds else 0

    def take_status(self, status):
        self.status = status

    def take_diagnostics(self, array):
        for status in array.status:
            for pair in status.values:
                if pair.key == "poses of finger, until the force is sent, median, p99, largest [ms]":
                    self.latencies.append(float(pair.value.split(",")[0]))

    def test_F4_memory_and_latency_stay_as_they_are(self):
        rospy.init_node("soak")
        seconds, every = int(rospy.get_param("~seconds")), int(rospy.get_param("~mesh_every"))
        self.status, self.uuid, self.latencies = None, "", []
        clouds, forces = [], []
        self.mesher = rospy.ServiceProxy("/mesher_node/build_mesh", BuildMesh)
        rospy.Subscriber("/deformer_node/status", SimulationStatus, self.take_status)
        rospy.Subscriber("/diagnostics", DiagnosticArray, self.take_diagnostics)
        rospy.Subscriber("/deformed_cloud", PointCloud2, lambda cloud: clouds.append(cloud.width))
        rospy.Subscriber("/finger/servo_cf", WrenchStamped, lambda wrench: forces.append(wrench.wrench.force.z))
        # Tissue has been factorised and is moved.
        wait_for(lambda: any(forces) and self.status, 60)
        self.uuid = self.status.mesh_uuid
        deformer = xmlrpc.client.ServerProxy(rospy.get_master().lookupNode("/deformer_node")[2]).getPid("/soak")[2]
        stalled = subprocess.Popen([sys.executable, "-c", LISTENER], stdout=subprocess.PIPE)
        stalled.stdout.readline()
        stalled.send_signal(signal.SIGSTOP)
        try:
            # What allocators keep of a mesh that is gone is there from the first change on.
            sizes = itertools.cycle((6000, 9000))
            self.build(next(sizes))
            self.build(next(sizes))
            self.settle()
            poses, shown, meshes = len(forces), len(clouds), 0
            del self.latencies[:]
            memory = []
            end = time.monotonic() + seconds
            while time.monotonic() < end:
                for _ in range(every or 1):
                    rospy.rostime.wallsleep(1.0)
                if every:
                    self.settle()
                # Of the same mesh each: those of the smaller are another thing.
                memory.append(resident_kilobytes(deformer))
                if every:
                    self.build(next(sizes))
                    self.build(next(sizes))
                    meshes += 2
        finally:
            stalled.kill()
            stalled.wait()
        a_minute = 60.0 / seconds * len(memory)
        growth = slope(memory) * a_minute
        early, late = (statistics.median(part) for part in
                       (self.latencies[:len(self.latencies) // 2], self.latencies[len(self.latencies) // 2:]))
        print(f"soak: {seconds} s, {len(forces) - poses} forces to one of three tools, {len(clouds) - shown} clouds of "
              f"{clouds[-1]} vertices, {meshes} meshes; resident {memory[0]} kB at first, {min(memory)} to {max(memory)}, "
              f"slope {growth:.0f} kB/min; pose to force {early:.3f} ms in the first half, {late:.3f} in the second",
              flush=True)
        figure("F4", f"memory, most above the first in {seconds} s, {meshes} meshes [kB]", max(memory) - memory[0])
        figure("F4", "pose to force, median, second half [ms]", round(late, 3))
        if not every:
            self.assertLess(max(memory) - memory[0], 5000)
        if seconds >= 600:
            self.assertLess(growth, 100)
        self.assertLess(late, 2 * early + 0.1)
        self.assertGreater(len(clouds) - shown, 5 * seconds)
        self.assertGreater(len(forces) - poses, 100 * seconds)
        os.kill(deformer, 0)


if __name__ == "__main__":
    rostest.rosrun("soft_tissue_sim", "soak", Soak)
