#pragma once

#include "ros/parameters.h"

#include <ros/node_handle.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tissue_ros {

/// Ends a node; `well` unless another is to take its place, because the master was lost.
using EndNode = std::function<void(bool well)>;

/// Nodes that keep what they have for one that takes their place have a forget().
template <class Node>
auto forget(Node& node, int) -> decltype(node.forget()) {
  node.forget();
}
template <class Node>
void forget(Node&, long) {}

/// What --help says of a node, besides its parameters.
struct NodeHelp {
  const char *name, *about, *example;
};

/// The process of a node: `make`, told what command line is left when ROS has taken its part (files
/// of settings), begins a node. Returns the exit code: 0 when it was asked to end by SIGINT or
/// SIGTERM, after the work at hand is finished and what the node says at its end has got out; 1
/// with a sentence if there is no master, if the node cannot begin, when the master is lost, and
/// when somebody else shuts it down, as a second node of its name does. With --help it only says
/// what it is, which parameters it has, and ends with 0.
int run_process(int argc, char** argv, const NodeHelp& help,
                const std::function<EndNode(const std::vector<std::string>& files)>& make);

/// The main function of a node of this class, whose parameters are `Parameters`.
template <class Node, class Parameters>
int run_node(int argc, char** argv, const NodeHelp& help) {
  return run_process(argc, argv, help, [name = help.name](const std::vector<std::string>& files) {
    const ros::NodeHandle handle, private_handle("~");
    auto node = std::make_shared<Node>(handle, private_handle,
                                       Settings(name, files).read<Parameters>(private_handle));
    return [node](bool well) mutable {
      if (well) forget(*node, 0);
      node.reset();
    };
  });
}

}  // namespace tissue_ros
