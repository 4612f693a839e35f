#include "ros/deformer_node.h"
#include "ros/node_main.h"

int main(int argc, char** argv) {
  using namespace tissue_ros;
  return run_node<DeformerNode, DeformerNodeParameters>(
      argc, argv,
      {"deformer_node",
       "Moves the mesh that it hears as its scene says, under the tools that it hears.",
       "rosrun soft_tissue_sim deformer_node _scene:=$PWD/config/scenes/live_palpate.yaml"});
}
