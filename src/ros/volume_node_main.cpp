#include "ros/volume_node.h"
#include "ros/node_main.h"

int main(int argc, char** argv) {
  using namespace tissue_ros;
  using Parameters = VolumeNodeParameters;
  return run_node<Parameters>(
      argc, argv, "volume_node",
      [](const ros::NodeHandle& handle, const ros::NodeHandle&, const Parameters& parameters) {
        return std::make_unique<VolumeNode>(handle, parameters);
      });
}
