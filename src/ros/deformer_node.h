#pragma once

#include "ros/display_mesh.h"
#include "ros/guarded.h"
#include "ros/parameters.h"
#include "tissue/simulate/scene.h"

#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/PoseStamped.h>
#include <ros/node_handle.h>
#include <soft_tissue_sim/TetMesh.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <optional>

namespace tissue_ros {

/// Takes `mesh` and `<tool>/measured_cp`, moves the mesh as the scene says, and publishes
/// `deformed_cloud`, `deformed_markers` and `~status`. A mesh or a pose that is refused changes
/// nothing. A tool that is silent for `tool_timeout` is lost, and the tissue relaxes in fixed
/// steps.
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
  };

  void take_mesh(const soft_tissue_sim::TetMesh& message);
  void take_pose(std::size_t tool, const geometry_msgs::PoseStamped& pose);
  void move_to(std::size_t tool, const geometry_msgs::PoseStamped& pose);
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

  // For each tool of the scene the newest pose that was used, and when it came by the wall clock.
  tissue::ToolPoses tools_;
  std::vector<ros::WallTime> heard_;
  ros::Time stamp_;
  tissue::StepReport last_step_;
  double step_seconds_ = 0.0;
  bool time_jumped_ = false;
  // Until they have been published once, markers replace those of the mesh before.
  bool markers_are_new_ = false;
  std::uint64_t dropped_poses_ = 0, rejected_meshes_ = 0;

  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_{transforms_};
  ros::Publisher cloud_publisher_, marker_publisher_, status_publisher_;
  ros::Subscriber mesh_subscriber_;
  std::vector<ros::Subscriber> pose_subscribers_;
  std::vector<ros::WallTimer> timers_;
  diagnostic_updater::Updater diagnostics_;
};

}  // namespace tissue_ros
