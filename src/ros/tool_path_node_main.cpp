#include "ros/tool_path_node.h"
#include "ros/node_main.h"

int main(int argc, char** argv) {
  using namespace tissue_ros;
  using Parameters = ToolPathNodeParameters;
  return run_node<Parameters>(
      argc, argv, "tool_path_node",
      [](const ros::NodeHandle& handle, const ros::NodeHandle&, const Parameters& parameters) {
        return std::make_unique<ToolPathNode>(handle, parameters);
      });
}
