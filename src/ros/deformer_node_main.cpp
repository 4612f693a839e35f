#include "ros/deformer_node.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <csignal>

namespace {

volatile std::sig_atomic_t is_over = 0;
void end(int) { is_over = 1; }

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "deformer_node", ros::init_options::NoSigintHandler);
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
  std::signal(SIGINT, end);
  std::signal(SIGTERM, end);
  while (ros::ok() && is_over == 0) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
  }
  // Its last word to every tool is that nothing is felt; that has to get out.
  node.reset();
  ros::WallDuration(0.1).sleep();
  ros::shutdown();
  return 0;
}
