#include "ros/deformer_node.h"
#include "ros/node_main.h"

int main(int argc, char** argv) {
  using namespace tissue_ros;
  return run_node<DeformerNode, DeformerNodeParameters>(argc, argv, "deformer_node");
}
