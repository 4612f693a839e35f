#pragma once

#include "ros/guarded.h"
#include "ros/kept_state.h"
#include "ros/simulation.h"
#include "ros/tool_listener.h"

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <soft_tissue_sim/LoadScene.h>
#include <soft_tissue_sim/Pause.h>
#include <soft_tissue_sim/Reset.h>
#include <soft_tissue_sim/TetMesh.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <optional>

namespace tissue_ros {

/// Takes `mesh` and what the scene's tools say, moves the mesh as the scene says, and publishes
/// `deformed_cloud`, `deformed_markers`, `~probes`, `~status` and the forces on the tools; another
/// scene, a reset and a pause by services. Steps, poses with forces, and clouds have a thread each.
/// What is refused changes nothing. Live, the newest pose of each tool wins, and a tool that is
/// silent for `tool_timeout` is lost, and the tissue relaxes in fixed steps. With `deterministic`
/// nothing but the poses and their stamps decides what happens (see tissue::Playback), and listening
/// to tools begins with the mesh.
class DeformerNode {
 public:
  /// Throws tissue::InputError if the scene cannot be read.
  DeformerNode(ros::NodeHandle handle, ros::NodeHandle private_handle,
               const DeformerNodeParameters& parameters);

  /// The node ends well: what it kept for one that takes its place is of no use.
  void forget() { kept_.forget(); }

 private:
  using TetMesh = soft_tissue_sim::TetMesh;
  using LoadScene = soft_tissue_sim::LoadScene;
  using Pause = soft_tissue_sim::Pause;
  using Reset = soft_tissue_sim::Reset;

  void advertise(ros::NodeHandle handle, ros::NodeHandle private_handle);
  void serve(ros::NodeHandle handle, ros::NodeHandle private_handle);
  void take_mesh(const TetMesh& message);
  bool load_scene(LoadScene::Request& request, LoadScene::Response& response);
  bool reset(Reset::Request& request, Reset::Response& response);
  bool pause(Pause::Request& request, Pause::Response& response);
  std::unique_ptr<Simulation> simulation_of(std::shared_ptr<const tissue::TetMesh> mesh,
                                            const tissue::SceneDescription& scene);
  void begin(std::unique_ptr<Simulation> simulation);
  std::unique_ptr<ToolListener> listener_for(const tissue::SceneDescription& scene);
  void publish(const Simulation::Clouds& clouds);
  void publish_clouds();
  void publish_markers();
  void publish_status();
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);
  template <class Work>
  soft_tissue_sim::Result result_of(const char* what, const Work& work);

  DeformerNodeParameters parameters_;
  ros::NodeHandle handle_;
  KeptState kept_;
  tissue::SceneDescription scene_;
  // Before the threads that use them.
  Meter clouds_published_;
  ros::Publisher cloud_publisher_, marker_publisher_, probe_publisher_, status_publisher_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_{transforms_};
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<ToolListener> tools_;
  std::size_t time_jumps_told_ = 0;
  // Until they have been published once, markers replace those of the mesh before.
  bool markers_are_new_ = false;
  std::uint64_t rejected_meshes_ = 0;

  ros::Subscriber mesh_subscriber_;
  std::vector<ros::ServiceServer> services_;
  std::vector<ros::WallTimer> timers_;
  diagnostic_updater::Updater diagnostics_;
};

}  // namespace tissue_ros
