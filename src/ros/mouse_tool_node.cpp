#include "ros/mouse_tool_node.h"

#include "ros/geometry.h"
#include "ros/markers.h"
#include "ros/tool_path_node.h"

#include <cmath>

namespace tissue_ros {

visualization_msgs::InteractiveMarker mouse_marker(const MouseToolNodeParameters& parameters) {
  using Control = visualization_msgs::InteractiveMarkerControl;
  visualization_msgs::InteractiveMarker marker;
  marker.header.frame_id = parameters.frame_id;
  marker.name = parameters.tool;
  marker.description = "drag " + parameters.tool;
  marker.scale = static_cast<float>(8.0 * parameters.radius);
  marker.pose.position = point_message(place_from("at", parameters.at));
  marker.pose.orientation.w = 1.0;

  Control ball;
  ball.name = "anywhere";
  ball.always_visible = 1;
  ball.interaction_mode = Control::MOVE_3D;
  ball.orientation.w = 1.0;
  ball.markers.push_back(
      ball_marker(parameters.tool, tissue::Vec3::Zero(), parameters.radius, 0.6f, ""));
  marker.controls.push_back(ball);
  // An arrow lies along x of its orientation.
  for (int axis = 0; axis < 3; ++axis) {
    Control arrow;
    arrow.name = std::string("along ") + "xyz"[axis];
    arrow.interaction_mode = Control::MOVE_AXIS;
    arrow.orientation.w = std::sqrt(0.5);
    (axis == 0   ? arrow.orientation.x
     : axis == 1 ? arrow.orientation.z
                 : arrow.orientation.y) = std::sqrt(0.5);
    marker.controls.push_back(arrow);
  }
  return marker;
}

MouseToolNode::MouseToolNode(ros::NodeHandle handle, const ros::NodeHandle&,
                             const MouseToolNodeParameters& parameters)
    : parameters_(parameters), server_(parameters.tool + "_marker") {
  publisher_ = handle.advertise<geometry_msgs::PoseStamped>(parameters.tool + "/measured_cp", 1);
  server_.insert(mouse_marker(parameters),
                 [this](const visualization_msgs::InteractiveMarkerFeedbackConstPtr& feedback) {
                   take(*feedback);
                 });
  server_.applyChanges();
  timer_ = handle.createWallTimer(ros::WallDuration(1.0 / parameters.rate),
                                  [this](const ros::WallTimerEvent&) { publish(); });
}

void MouseToolNode::take(const visualization_msgs::InteractiveMarkerFeedback& feedback) {
  using Feedback = visualization_msgs::InteractiveMarkerFeedback;
  // Where the view's fixed frame is another, so is the feedback's.
  pose_.header.frame_id = feedback.header.frame_id;
  pose_.pose = feedback.pose;
  if (feedback.event_type == Feedback::MOUSE_UP) is_held_ = false;
  if (feedback.event_type == Feedback::MOUSE_DOWN) is_held_ = true;
}

void MouseToolNode::publish() {
  if (!is_held_) return;
  pose_.header.stamp = ros::Time::now();
  publisher_.publish(pose_);
}

}  // namespace tissue_ros
