#include "ros/deformer_node.h"
#include "ros/node_main.h"

int main(int argc, char** argv) {
  using namespace tissue_ros;
  using Parameters = DeformerNodeParameters;
  return run_node<Parameters>(
      argc, argv, "deformer_node",
      [](const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
         const Parameters& parameters) {
        return std::make_unique<DeformerNode>(handle, private_handle, parameters);
      });
}
