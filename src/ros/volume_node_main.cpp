#include "ros/guarded.h"
#include "ros/volume_node.h"

#include <ros/ros.h>

#include <memory>

int main(int argc, char** argv) {
  ros::init(argc, argv, "volume_node");
  ros::NodeHandle handle;
  const auto parameters =
      tissue_ros::read_parameters<tissue_ros::VolumeNodeParameters>(ros::NodeHandle("~"));
  std::unique_ptr<tissue_ros::VolumeNode> node;
  const tissue_ros::Outcome outcome = tissue_ros::guarded(
      [&] { node = std::make_unique<tissue_ros::VolumeNode>(handle, parameters); });
  if (!outcome.ok()) {
    ROS_FATAL("volume_node: %s: %s", tissue::name(outcome.code), outcome.sentence.c_str());
    return 1;
  }
  ros::spin();
  return 0;
}
