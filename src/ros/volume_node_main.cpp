#include "ros/volume_node.h"
#include "ros/node_main.h"

int main(int argc, char** argv) {
  using namespace tissue_ros;
  return run_node<VolumeNode, VolumeNodeParameters>(
      argc, argv,
      {"volume_node",
       "Reads a volume and publishes it, with a tumour put into it, cropped and masked as the "
       "parameters say.",
       "rosrun soft_tissue_sim volume_node _file:=$PWD/data/ch2bet.nii.gz"});
}
