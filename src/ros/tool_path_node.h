#pragma once

#include "ros/parameters.h"
#include "tissue/simulate/pose_path.h"

#include <ros/node_handle.h>

namespace tissue_ros {

/// A tool without a device: publishes the poses of a path, again and again, on `<tool>/measured_cp`
/// with the stamps of now.
class ToolPathNode {
 public:
  /// Throws tissue::InputError that names the parameter.
  ToolPathNode(ros::NodeHandle handle, const ros::NodeHandle& private_handle,
               const ToolPathNodeParameters& parameters);

 private:
  void publish();

  ToolPathNodeParameters parameters_;
  std::vector<tissue::StampedPose> path_;
  ros::WallTime start_;
  ros::Publisher publisher_;
  ros::WallTimer timer_;
};

/// Three numbers of a parameter as a place [m]. Throws tissue::InputError that names it.
tissue::Vec3 place_from(const char* name, const std::vector<double>& numbers);

/// The path that the parameters say. Throws tissue::InputError that names the parameter.
std::vector<tissue::StampedPose> path_of(const ToolPathNodeParameters& parameters);

}  // namespace tissue_ros
