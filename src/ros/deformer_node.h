#pragma once

#include "ros/device_messages.h"
#include "ros/display_mesh.h"
#include "ros/guarded.h"
#include "ros/parameters.h"

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <soft_tissue_sim/TetMesh.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <optional>

namespace tissue_ros {

/// Takes `mesh` and what the scene's tools say, moves the mesh as the scene says, and publishes
/// `deformed_cloud`, `deformed_markers` and `~status`. A mesh or a pose that is refused changes
/// nothing. Live, the newest pose of each tool wins, and a tool that is silent for `tool_timeout`
/// is lost, and the tissue relaxes in fixed steps. With `deterministic` nothing but the poses and
/// their stamps decides what happens (see tissue::Playback), and listening to tools begins with the
/// mesh.
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
    tissue::Scene scene;
    // One for each tool.
    std::vector<DeviceReader> readers;
    // Of poses that are replayed; nothing live.
    std::optional<tissue::Playback> playback;
  };

  void take_mesh(const soft_tissue_sim::TetMesh& message);
  void listen_to_tools();
  void listen(const std::string& topic, std::function<void(const AnyMessage&)> take);
  void take_pose(std::size_t tool, const AnyMessage& message);
  void take_grip(std::size_t tool, const AnyMessage& message);
  void move_to(const tissue::ToolSample& sample);
  void replay();
  void finish_replay();
  void count_step(const tissue::StepReport& step, double seconds);
  const tissue::ToolPoses& tools() const;
  void lose_tools();
  bool has_a_tool() const;
  void drop_pose(const std::string& why);
  void watch_tool();
  void publish_cloud();
  void publish_markers();
  void publish_status();
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  DeformerNodeParameters parameters_;
  tissue::SceneDescription scene_;
  std::optional<Simulation> simulation_;

  ros::NodeHandle handle_;
  // For each tool of the scene the newest pose that was used, when it came by the wall clock, its
  // jaw, and whether its device is at work.
  tissue::ToolPoses tools_;
  std::vector<ros::WallTime> heard_;
  std::vector<std::optional<bool>> closed_;
  std::vector<std::uint8_t> enabled_;
  ros::Time stamp_;
  tissue::StepReport last_step_;
  double step_seconds_ = 0.0;
  bool time_jumped_ = false;
  std::size_t time_jumps_told_ = 0;
  // Until they have been published once, markers replace those of the mesh before.
  bool markers_are_new_ = false;
  std::uint64_t dropped_poses_ = 0, rejected_meshes_ = 0;

  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_{transforms_};
  ros::Publisher cloud_publisher_, marker_publisher_, status_publisher_;
  ros::Subscriber mesh_subscriber_;
  std::vector<ros::Subscriber> tool_subscribers_;
  std::vector<ros::WallTimer> timers_;
  diagnostic_updater::Updater diagnostics_;
};

}  // namespace tissue_ros
