#include "ros/mouse_tool_node.h"
#include "ros/node_main.h"

int main(int argc, char** argv) {
  using namespace tissue_ros;
  return run_node<MouseToolNode, MouseToolNodeParameters>(
      argc, argv,
      {"mouse_tool_node", "A tool that the mouse drags in rviz, by an interactive marker.",
       "rosrun soft_tissue_sim mouse_tool_node _tool:=finger _at:=[0.002,-0.020,0.085]"});
}
