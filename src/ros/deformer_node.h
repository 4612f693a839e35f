#pragma once

#include "ros/display_mesh.h"
#include "ros/guarded.h"
#include "ros/parameters.h"
#include "ros/tool_listener.h"

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <soft_tissue_sim/TetMesh.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <optional>

namespace tissue_ros {

/// Takes `mesh` and what the scene's tools say, moves the mesh as the scene says, and publishes
/// `deformed_cloud`, `deformed_markers`, `~status` and the forces on the tools. Steps, poses with
/// forces, and clouds have a thread each. A mesh or a pose that is refused changes nothing. Live,
/// the newest pose of each tool wins, and a tool that is silent for `tool_timeout` is lost, and the
/// tissue relaxes in fixed steps. With `deterministic` nothing but the poses and their stamps
/// decides what happens (see tissue::Playback), and listening to tools begins with the mesh.
class DeformerNode {
 public:
  /// Throws tissue::InputError if the scene cannot be read or a rate is not positive.
  DeformerNode(ros::NodeHandle handle, ros::NodeHandle private_handle,
               const DeformerNodeParameters& parameters);

 private:
  /// All that belongs to one mesh.
  struct Simulation {
    tissue::TetMesh mesh;
    std::vector<std::uint8_t> vertex_levels;
    DisplayMesh display;
    std::shared_ptr<SceneWorker> worker;
  };

  void take_mesh(const soft_tissue_sim::TetMesh& message);
  std::shared_ptr<SceneWorker> worker_for(const tissue::TetMesh& mesh,
                                          const std::vector<std::uint8_t>& levels);
  void publish_cloud();
  void publish_markers();
  void publish_status();
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  DeformerNodeParameters parameters_;
  tissue::SceneDescription scene_;
  // Before the threads that use them.
  ros::Publisher cloud_publisher_, marker_publisher_, status_publisher_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_{transforms_};
  std::optional<Simulation> simulation_;
  std::optional<ToolListener> tools_;
  std::size_t time_jumps_told_ = 0;
  // Until they have been published once, markers replace those of the mesh before.
  bool markers_are_new_ = false;
  std::uint64_t rejected_meshes_ = 0;

  ros::Subscriber mesh_subscriber_;
  std::vector<ros::WallTimer> timers_;
  diagnostic_updater::Updater diagnostics_;
};

}  // namespace tissue_ros
