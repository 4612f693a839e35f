#include "ros/deformer_node.h"

#include <ros/ros.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "deformer_node");
  ros::NodeHandle handle;
  ros::NodeHandle private_handle("~");
  std::unique_ptr<tissue_ros::DeformerNode> node;
  const tissue_ros::Outcome outcome = tissue_ros::guarded([&] {
    node = std::make_unique<tissue_ros::DeformerNode>(
        handle, private_handle,
        tissue_ros::read_parameters<tissue_ros::DeformerNodeParameters>(private_handle));
  });
  if (!outcome.ok()) {
    ROS_FATAL("deformer_node: %s: %s", tissue::name(outcome.code), outcome.sentence.c_str());
    return 1;
  }
  ros::spin();
  return 0;
}
