#!/usr/bin/env python3
"""Tissue as a solid in deformer_node: its weight, two tools, and back again."""
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from sensor_msgs import point_cloud2
from sensor_msgs.msg import PointCloud2
from soft_tissue_sim.msg import Result, SimulationStatus, Volume
from soft_tissue_sim.srv import BuildMesh
from visualization_msgs.msg import MarkerArray

from ball_volume import CENTRE, RADIUS, ball, request

CENTRE_M = CENTRE * 1e-3
SIDE = RADIUS * 1e-3


class Solid(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("solid_test")
        cls.tools = {name: rospy.Publisher(name + "/measured_cp", PoseStamped, queue_size=1)
                     for name in ("left", "right")}
        # How far the tools have moved apart [m]; None while they are silent.
        cls.outward = None
        cls.timer = rospy.Timer(rospy.Duration(0.02), cls.send_poses)
        volume = rospy.Publisher("volume", Volume, queue_size=1, latch=True)
        volume.publish(ball())
        build = rospy.ServiceProxy("mesher_node/build_mesh", BuildMesh)
        build.wait_for_service(30)
        while True:
            result = build(request()).result
            if result.code != Result.E_NO_VOLUME:
                break
            rospy.rostime.wallsleep(0.05)
        assert result.code == Result.OK, result.message

    def cloud(self):
        message = rospy.wait_for_message("deformed_cloud", PointCloud2, timeout=30)
        return list(point_cloud2.read_points(message, ["x", "y", "z", "displacement"]))

    def status(self):
        return rospy.wait_for_message("deformer_node/status", SimulationStatus, timeout=30)

    def largest(self):
        return max(p[3] for p in self.cloud())

    @classmethod
    def send_poses(cls, _):
        if cls.outward is None:
            return
        for side, name in ((-1.0, "left"), (1.0, "right")):
            pose = PoseStamped()
            pose.header.frame_id = "patient"
            pose.header.stamp = rospy.Time.now()
            pose.pose.position.x = CENTRE_M + side * (SIDE + cls.outward)
            pose.pose.position.y = pose.pose.position.z = CENTRE_M
            pose.pose.orientation.w = 1.0
            cls.tools[name].publish(pose)

    def reach(self, condition):
        for _ in range(100):
            if condition():
                return
        self.fail("what was waited for never came")

    def test_1_the_weight_is_there_before_any_tool(self):
        self.assertGreater(self.largest(), 1e-5)
        status = self.status()
        self.assertEqual((status.model, status.scene), ("corotational", "two_fingers"))
        self.assertEqual([e.name for e in status.effects], ["gravity"])
        self.assertEqual(list(status.flags), ["TOOL_LOST"])
        self.assertGreater(status.iterations, 0)
        self.assertLess(status.residual, 1e-3)
        self.assertIn(status.solver, ("cholmod", "ldlt", "multigrid", "p-multigrid"))
        self.assertTrue(status.energy == status.energy)

    def test_2_two_tools_pull_the_ball_apart_and_let_it_go(self):
        at_rest = self.largest()
        Solid.outward = 0.0
        self.reach(lambda: "TOOL_LOST" not in self.status().flags)
        Solid.outward = 0.002
        self.reach(lambda: self.largest() > 0.0019)
        places = self.cloud()
        self.assertGreater(max(p[0] for p in places) - min(p[0] for p in places), 2 * SIDE + 0.003)
        status = self.status()
        self.assertEqual((status.inverted, status.rejected_meshes), (0, 0))
        markers = rospy.wait_for_message("deformed_markers", MarkerArray, timeout=30).markers
        self.assertLessEqual({"left", "right"}, {m.ns for m in markers})
        # Silent tools let go: what is left is the weight.
        Solid.outward = None
        self.reach(lambda: abs(self.largest() - at_rest) < 1e-5)


if __name__ == "__main__":
    rostest.rosrun("soft_tissue_sim", "solid", Solid)
