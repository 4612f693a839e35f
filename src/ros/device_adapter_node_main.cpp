#include "ros/device_adapter_node.h"
#include "ros/node_main.h"

int main(int argc, char** argv) {
  using namespace tissue_ros;
  return run_node<DeviceAdapterNode, DeviceAdapterNodeParameters>(argc, argv, "device_adapter_node");
}
