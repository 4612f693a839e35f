#include "ros/volume_node.h"
#include "ros/node_main.h"

int main(int argc, char** argv) {
  using namespace tissue_ros;
  return run_node<VolumeNode, VolumeNodeParameters>(argc, argv, "volume_node");
}
