#pragma once

#include "ros/parameters.h"

#include <geometry_msgs/PoseStamped.h>
#include <interactive_markers/interactive_marker_server.h>
#include <ros/node_handle.h>

namespace tissue_ros {

/// A tool for the mouse in rviz: an interactive marker that is dragged. The tool is there as long
/// as the mouse holds it, and then publishes its pose on `<tool>/measured_cp`; when it is let go
/// the tissue is let go too, and the marker waits where it is.
class MouseToolNode {
 public:
  /// Throws tissue::InputError that names the parameter.
  MouseToolNode(ros::NodeHandle handle, const ros::NodeHandle& private_handle,
                const MouseToolNodeParameters& parameters);

 private:
  void take(const visualization_msgs::InteractiveMarkerFeedback& feedback);
  void publish();

  MouseToolNodeParameters parameters_;
  geometry_msgs::PoseStamped pose_;
  bool is_held_ = false;
  ros::Publisher publisher_;
  interactive_markers::InteractiveMarkerServer server_;
  ros::WallTimer timer_;
};

/// The marker that the mouse takes hold of: a ball of the tool's radius that is dragged in the
/// view's plane, and arrows along x, y and z. Throws tissue::InputError that names the parameter.
visualization_msgs::InteractiveMarker mouse_marker(const MouseToolNodeParameters& parameters);

}  // namespace tissue_ros
