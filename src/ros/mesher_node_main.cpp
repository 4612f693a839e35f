#include "ros/mesher_node.h"

#include <ros/ros.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "mesher_node");
  ros::NodeHandle handle;
  ros::NodeHandle private_handle("~");
  tissue_ros::MesherNode node(
      handle, private_handle,
      tissue_ros::read_parameters<tissue_ros::MesherNodeParameters>(private_handle));
  ros::spin();
  return 0;
}
