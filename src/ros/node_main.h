#pragma once

#include "ros/guarded.h"
#include "ros/parameters.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <csignal>
#include <memory>

namespace tissue_ros {

inline volatile std::sig_atomic_t is_over = 0;

/// The main function of a node that `make(handle, private_handle, parameters)` makes a unique_ptr
/// of: 0 when it is asked to end, 1 with a sentence if it cannot begin. On SIGINT and SIGTERM the
/// work at hand is finished, and what the node says when it is destroyed gets out.
template <class Parameters, class Make>
int run_node(int argc, char** argv, const char* name, const Make& make) {
  ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
  ros::NodeHandle handle;
  const ros::NodeHandle private_handle("~");
  decltype(make(handle, private_handle, Parameters())) node;
  const Outcome outcome = guarded(
      [&] { node = make(handle, private_handle, read_parameters<Parameters>(private_handle)); });
  if (!outcome.ok()) {
    ROS_FATAL("%s: %s: %s", name, tissue::name(outcome.code), outcome.sentence.c_str());
    return 1;
  }
  const auto end = [](int) { is_over = 1; };
  std::signal(SIGINT, end);
  std::signal(SIGTERM, end);
  while (ros::ok() && is_over == 0) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
  }
  node.reset();
  ros::WallDuration(0.1).sleep();
  ros::shutdown();
  return 0;
}

}  // namespace tissue_ros
