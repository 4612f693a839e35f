#include "ros/mouse_tool_node.h"
#include "ros/node_main.h"

int main(int argc, char** argv) {
  using namespace tissue_ros;
  return run_node<MouseToolNode, MouseToolNodeParameters>(argc, argv, "mouse_tool_node");
}
