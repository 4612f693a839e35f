#!/usr/bin/env python3
"""Tissue as a solid in deformer_node: its weight, two tools, and back again."""
import rospy
import rostest
from visualization_msgs.msg import MarkerArray

from ball_volume import CENTRE, RADIUS
from deformer_client import DeformerCase

CENTRE_M = CENTRE * 1e-3
SIDE = RADIUS * 1e-3


class Solid(DeformerCase):
    TOOLS = ("left", "right")

    def pull(self, outward):
        """Both tools are so far beyond the ball's sides [m]."""
        Solid.places = {name: (CENTRE_M + side * (SIDE + outward), CENTRE_M, CENTRE_M)
                        for side, name in ((-1.0, "left"), (1.0, "right"))}

    def width(self):
        places = [point[0] for point in self.cloud()]
        return max(places) - min(places)

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
        self.pull(0.0)
        self.reach(lambda: "TOOL_LOST" not in self.status().flags)
        self.pull(0.002)
        self.reach(lambda: self.width() > 2 * SIDE + 0.003)
        status = self.status()
        self.assertEqual((status.inverted, status.rejected_meshes), (0, 0))
        markers = rospy.wait_for_message("deformed_markers", MarkerArray, timeout=30).markers
        self.assertLessEqual({"left", "right"}, {m.ns for m in markers})
        # Silent tools let go: what is left is the weight.
        Solid.places = {}
        self.reach(lambda: abs(self.largest() - at_rest) < 1e-5)


if __name__ == "__main__":
    rostest.rosrun("soft_tissue_sim", "solid", Solid)
