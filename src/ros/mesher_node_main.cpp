#include "ros/mesher_node.h"
#include "ros/node_main.h"

int main(int argc, char** argv) {
  using namespace tissue_ros;
  return run_node<MesherNode, MesherNodeParameters>(argc, argv, "mesher_node");
}
