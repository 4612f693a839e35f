#include "ros/tool_path_node.h"
#include "ros/node_main.h"

int main(int argc, char** argv) {
  using namespace tissue_ros;
  return run_node<ToolPathNode, ToolPathNodeParameters>(
      argc, argv,
      {"tool_path_node", "A tool without a device: publishes poses along a path, again and again.",
       "rosrun soft_tissue_sim tool_path_node _tool:=finger "
       "_file:=$PWD/config/paths/press_tumour.csv"});
}
