#!/usr/bin/env python3
"""The tool for the mouse is there while the mouse holds it."""
import rospy
import rostest
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit

from ball_volume import CENTRE, RADIUS
from deformer_client import DeformerCase

CENTRE_M = CENTRE * 1e-3
FINGER = 0.004


class Mouse(DeformerCase):
    def test_it_pushes_while_it_is_held_and_lets_go(self):
        shown = rospy.wait_for_message("finger_marker/update_full", InteractiveMarkerInit, timeout=20)
        self.assertEqual([marker.name for marker in shown.markers], ["finger"])
        self.assertEqual(len(shown.markers[0].controls), 4)
        mouse = rospy.Publisher("finger_marker/feedback", InteractiveMarkerFeedback, queue_size=10)
        self.reach(lambda: rospy.rostime.wallsleep(0.05) or mouse.get_num_connections() > 0)

        def drag(event, depth):
            feedback = InteractiveMarkerFeedback(client_id="rviz", marker_name="finger", event_type=event)
            feedback.header.frame_id = "patient"
            place = feedback.pose.position
            place.x, place.y, place.z = CENTRE_M, CENTRE_M, CENTRE_M + RADIUS * 1e-3 + FINGER - depth
            feedback.pose.orientation.w = 1.0
            mouse.publish(feedback)

        self.assertEqual(self.largest(), 0.0)
        drag(InteractiveMarkerFeedback.MOUSE_DOWN, -0.002)
        self.reach(lambda: "TOOL_LOST" not in self.status().flags)
        drag(InteractiveMarkerFeedback.POSE_UPDATE, 0.002)
        self.reach(lambda: self.largest() > 0.001)
        drag(InteractiveMarkerFeedback.MOUSE_UP, 0.002)
        self.reach(lambda: "TOOL_LOST" in self.status().flags)
        self.reach(lambda: self.largest() < 1e-5)


if __name__ == "__main__":
    rostest.rosrun("soft_tissue_sim", "mouse", Mouse)
