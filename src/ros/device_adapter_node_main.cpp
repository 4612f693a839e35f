#include "ros/device_adapter_node.h"
#include "ros/node_main.h"

int main(int argc, char** argv) {
  using namespace tissue_ros;
  return run_node<DeviceAdapterNode, DeviceAdapterNodeParameters>(
      argc, argv,
      {"device_adapter_node",
       "Translates what drivers say that speak neither PoseStamped nor WrenchStamped.",
       "rosrun soft_tissue_sim device_adapter_node _device:=omni _name:=phantom _tool:=stylus"});
}
