// The nodes as nodelets: in one process, messages are passed on as pointers.
#include "ros/deformer_node.h"
#include "ros/guarded.h"
#include "ros/master_watch.h"
#include "ros/mesher_node.h"
#include "ros/node_main.h"
#include "ros/volume_node.h"

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>
#include <ros/init.h>

#include <atomic>
#include <stdexcept>

namespace tissue_ros {

/// A node of this class, whose section in files of settings has this name.
template <class Node, class Parameters, const char* kName>
class NodeAsNodelet : public nodelet::Nodelet {
 public:
  ~NodeAsNodelet() override {
    watch_.reset();
    if (node_ != nullptr && !master_is_lost_) forget(*node_, 0);
  }

 private:
  void onInit() override {
    const Outcome outcome = guarded([&] {
      const ros::NodeHandle private_handle = getPrivateNodeHandle();
      node_ = std::make_unique<Node>(getNodeHandle(), private_handle,
                                     Settings(kName, getMyArgv()).read<Parameters>(private_handle));
    });
    if (!outcome.ok()) {
      NODELET_FATAL("%s: %s: %s", kName, tissue::name(outcome.code), outcome.sentence.c_str());
      throw std::runtime_error(outcome.sentence);
    }
    watch_ = std::make_unique<MasterWatch>([this] {
      master_is_lost_ = true;
      ros::requestShutdown();
    });
  }

  std::unique_ptr<Node> node_;
  std::atomic<bool> master_is_lost_{false};
  std::unique_ptr<MasterWatch> watch_;
};

extern const char kVolume[] = "volume_node", kMesher[] = "mesher_node",
                  kDeformer[] = "deformer_node";
using VolumeNodelet = NodeAsNodelet<VolumeNode, VolumeNodeParameters, kVolume>;
using MesherNodelet = NodeAsNodelet<MesherNode, MesherNodeParameters, kMesher>;
using DeformerNodelet = NodeAsNodelet<DeformerNode, DeformerNodeParameters, kDeformer>;

}  // namespace tissue_ros

PLUGINLIB_EXPORT_CLASS(tissue_ros::VolumeNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(tissue_ros::MesherNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(tissue_ros::DeformerNodelet, nodelet::Nodelet)
