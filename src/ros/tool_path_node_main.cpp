#include "ros/tool_path_node.h"
#include "ros/node_main.h"

int main(int argc, char** argv) {
  using namespace tissue_ros;
  return run_node<ToolPathNode, ToolPathNodeParameters>(argc, argv, "tool_path_node");
}
