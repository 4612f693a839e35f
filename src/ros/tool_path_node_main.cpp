#include "ros/guarded.h"
#include "ros/tool_path_node.h"

#include <ros/ros.h>

#include <memory>

int main(int argc, char** argv) {
  ros::init(argc, argv, "tool_path_node");
  ros::NodeHandle handle;
  const auto parameters =
      tissue_ros::read_parameters<tissue_ros::ToolPathNodeParameters>(ros::NodeHandle("~"));
  std::unique_ptr<tissue_ros::ToolPathNode> node;
  const tissue_ros::Outcome outcome = tissue_ros::guarded(
      [&] { node = std::make_unique<tissue_ros::ToolPathNode>(handle, parameters); });
  if (!outcome.ok()) {
    ROS_FATAL("tool_path_node: %s: %s", tissue::name(outcome.code), outcome.sentence.c_str());
    return 1;
  }
  ros::spin();
  return 0;
}
