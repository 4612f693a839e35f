#include "ros/mesher_node.h"
#include "ros/node_main.h"

int main(int argc, char** argv) {
  using namespace tissue_ros;
  using Parameters = MesherNodeParameters;
  return run_node<Parameters>(
      argc, argv, "mesher_node",
      [](const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
         const Parameters& parameters) {
        return std::make_unique<MesherNode>(handle, private_handle, parameters);
      });
}
