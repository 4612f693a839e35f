#!/usr/bin/env python3
"""Nodes under a clock that is not the wall's."""
import subprocess
import unittest

import rostest

from ros_world import World, wait_for

SIM_TIME = """
import rospy
from geometry_msgs.msg import PoseStamped
from rosgraph_msgs.msg import Clock
from soft_tissue_sim.msg import SimulationStatus
rospy.init_node("clock", disable_signals=True)
clock = rospy.Publisher("/clock", Clock, queue_size=10)
pose = rospy.Publisher("/tool/measured_cp", PoseStamped, queue_size=1)
flags = []
rospy.Subscriber("/deformer_node/status", SimulationStatus, lambda status: flags.extend(status.flags))
# Twice the same three seconds, as a bag that is played again: the clock is set back in between.
for _ in range(2):
    for i in range(1, 151):
        now = rospy.Time(0.02 * i)
        clock.publish(now)
        message = PoseStamped()
        message.header.stamp, message.header.frame_id = now, "patient"
        message.pose.position.y, message.pose.position.z = -0.02, 0.08
        message.pose.orientation.w = 1.0
        pose.publish(message)
        rospy.rostime.wallsleep(0.02)
while "TIME_JUMP" not in flags:
    rospy.rostime.wallsleep(0.05)
print(1)
"""


class SimulatedTime(unittest.TestCase):
    def test_F3_a_clock_that_is_set_back_stops_nobody(self):
        world = World()
        try:
            subprocess.run(["rosparam", "set", "/use_sim_time", "true"], env=world.env, check=True)
            # No clock ticks yet, and yet there is a mesh.
            world.launch("demo.launch", "rviz:=false", "play:=false", "initial_tetrahedra:=2000")
            wait_for(lambda: world.process_of("/deformer_node"), 30)
            deformer = world.process_of("/deformer_node")
            self.assertEqual(world.ask(SIM_TIME, 60), 1)
            self.assertEqual(world.process_of("/deformer_node"), deformer)
        finally:
            world.end()


if __name__ == "__main__":
    rostest.rosrun("soft_tissue_sim", "simulated_time", SimulatedTime)
