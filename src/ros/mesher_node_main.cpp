#include "ros/mesher_node.h"
#include "ros/node_main.h"

int main(int argc, char** argv) {
  using namespace tissue_ros;
  return run_node<MesherNode, MesherNodeParameters>(
      argc, argv,
      {"mesher_node", "Makes tetrahedral meshes of the volumes that it hears, on request.",
       "rosrun soft_tissue_sim mesher_node _build_on_volume:=true _initial_tetrahedra:=6000"});
}
