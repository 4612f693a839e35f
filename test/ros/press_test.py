#!/usr/bin/env python3
"""A finger that presses in deformer_node and what it feels, and what drivers do to it: a bag that starts again
(P3), a driver that dies (P9), two at once (P10)."""
import subprocess

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from soft_tissue_sim.msg import SimulationStatus

from ball_volume import CENTRE, RADIUS
from deformer_client import DeformerCase
from ros_world import program, tells_why

CENTRE_M = CENTRE * 1e-3
FINGER = 0.004


class Press(DeformerCase):
    TOOLS = ("finger",)

    @classmethod
    @tells_why
    def setUpClass(cls):
        super().setUpClass()
        # What it was told last that it feels [N].
        cls.felt = None
        rospy.Subscriber("finger/servo_cf", WrenchStamped, cls.feel)

    @classmethod
    def feel(cls, wrench):
        cls.felt = wrench.wrench.force

    def press(self, depth):
        """The finger is so far below where it would touch the ball's top [m]."""
        Press.places = {"finger": (CENTRE_M, CENTRE_M, CENTRE_M + RADIUS * 1e-3 + FINGER - depth)}
        self.reach(lambda: "TOOL_LOST" not in self.status().flags)

    def press_and_be_felt(self):
        self.press(0.002)
        self.reach(lambda: self.largest() > 0.001)

    def test_1_a_finger_presses_and_what_that_costs_is_told_by_name(self):
        self.assertEqual(self.largest(), 0.0)
        self.press(-0.002)
        self.assertEqual(self.largest(), 0.0)
        self.reach(lambda: self.status() and self.felt is not None)
        self.assertEqual(self.felt.z, 0.0)
        self.press_and_be_felt()
        # Away from the ball, by as much as so soft a ball can.
        self.reach(lambda: self.status() and self.felt.z > 0.002)
        self.assertLess(self.felt.z, 0.2)
        self.assertLess(abs(self.felt.x), 0.5 * self.felt.z)
        status = self.status()
        self.assertGreater(status.penetration, 0.0)
        self.assertLess(status.penetration, 0.01 * FINGER)
        self.assertEqual(list(status.flags), [])
        costs = {effect.name: effect for effect in status.effects}
        self.assertEqual(list(costs), ["contact", "inertia", "damping", "force_feedback"])
        for cost in costs.values():
            self.assertGreater(cost.seconds, 0.0, cost.name)
            self.assertGreater(cost.bytes, 0, cost.name)

    def test_2_P3_a_bag_that_starts_again_finds_the_tissue_at_rest(self):
        self.press_and_be_felt()
        Press.places = {}
        flags = []
        rospy.Subscriber("deformer_node/status", SimulationStatus, lambda status: flags.extend(status.flags))
        # One pose, of long ago, beside the organ.
        Press.behind = rospy.Duration(20)
        self.send("finger", (CENTRE_M, CENTRE_M, 0.05))
        self.reach(lambda: self.largest() == 0.0)
        self.reach(lambda: self.status() and "TIME_JUMP" in flags)
        self.press_and_be_felt()

    def test_3_P9_a_driver_that_dies_while_it_presses_leaves_tissue_that_relaxes(self):
        self.press_and_be_felt()
        Press.places = {}
        self.reach(lambda: "TOOL_LOST" in self.status().flags)
        self.assertEqual((self.felt.x, self.felt.y, self.felt.z), (0.0, 0.0, 0.0))
        # The clouds go on while it swings back.
        self.reach(lambda: self.largest() < 1e-5)
        self.press_and_be_felt()

    def test_4_P10_a_second_driver_is_not_heard_until_the_first_is_silent(self):
        self.press_and_be_felt()
        dropped = self.status().dropped_poses
        rospy.set_param("other", {"tool": "finger", "kind": "line", "from": [CENTRE_M, CENTRE_M, 0.05],
                                  "to": [CENTRE_M, CENTRE_M, 0.06]})
        other = subprocess.Popen([program("tool_path_node"), "__name:=other"])
        try:
            self.reach(lambda: self.status().dropped_poses > dropped + 10)
            self.assertGreater(self.largest(), 0.001)
            # Far above, the other is heard at last.
            Press.places = {}
            self.reach(lambda: self.largest() < 1e-5)
            self.reach(lambda: "TOOL_LOST" not in self.status().flags)
        finally:
            other.terminate()
            other.wait()

    def test_5_P4_P7_a_tool_that_jumps_a_metre_through_the_ball_folds_nothing_and_leaves_it_at_rest(self):
        self.press_and_be_felt()
        flags, inverted = [], []
        rospy.Subscriber("deformer_node/status", SimulationStatus,
                         lambda status: (flags.extend(status.flags), inverted.append(status.inverted)))
        # To the far side within one pose: what cannot be followed is said, and nothing is torn along.
        Press.places = {"finger": (CENTRE_M, CENTRE_M, CENTRE_M - 1.0)}
        self.reach(lambda: self.status() and "CLAMPED" in flags or self.largest() < 1e-5)
        self.reach(lambda: self.largest() < 1e-5)
        self.assertEqual(max(inverted), 0)
        self.assertEqual((self.felt.x, self.felt.y, self.felt.z), (0.0, 0.0, 0.0))
        # Taken away and brought back it presses as before.
        Press.places = {}
        self.reach(lambda: "TOOL_LOST" in self.status().flags)
        self.press_and_be_felt()


if __name__ == "__main__":
    rostest.rosrun("soft_tissue_sim", "press", Press)
