#include "ros/deformer_node.h"

#include "ros/convert.h"
#include "ros/markers.h"
#include "tissue/simulate/scene_file.h"

#include <sensor_msgs/PointCloud2.h>

#include <algorithm>
#include <cmath>

namespace tissue_ros {
namespace {

using tissue::ErrorCode;
using tissue::InputError;

void require_positive(const char* name, double value) {
  if (value > 0.0 && value <= 10000.0) return;
  throw InputError(ErrorCode::kParam, std::string("~") + name + ": " + tissue::to_text(value) +
                                          " is not between 0 and 10000");
}

}  // namespace

DeformerNode::DeformerNode(ros::NodeHandle handle, ros::NodeHandle private_handle,
                           const DeformerNodeParameters& parameters)
    : parameters_(parameters), diagnostics_(handle, private_handle) {
  require_positive("tool_timeout", parameters.tool_timeout);
  require_positive("cloud_rate", parameters.cloud_rate);
  require_positive("marker_rate", parameters.marker_rate);
  require_positive("status_rate", parameters.status_rate);
  if (!parameters.scene.empty()) scene_ = tissue::read_scene(parameters.scene);

  // Live, an old cloud is of no use; of a replay, none may be missing.
  cloud_publisher_ = handle.advertise<sensor_msgs::PointCloud2>(
      "deformed_cloud", parameters.deterministic ? 1000 : 2);
  marker_publisher_ = handle.advertise<visualization_msgs::MarkerArray>("deformed_markers", 1);
  status_publisher_ = private_handle.advertise<soft_tissue_sim::SimulationStatus>("status", 1);
  using TetMesh = soft_tissue_sim::TetMesh;
  mesh_subscriber_ = handle.subscribe<TetMesh>(
      "mesh", 1, [this](const TetMesh::ConstPtr& message) { take_mesh(*message); });
  ToolListenerOptions listening;
  listening.deterministic = parameters.deterministic;
  listening.tool_timeout = parameters.tool_timeout;
  listening.force.max_force = parameters.max_force;
  listening.force.max_rise = parameters.max_force_rise;
  tools_.emplace(handle, scene_, listening, transforms_);

  const auto every = [&](double rate, void (DeformerNode::*work)()) {
    timers_.push_back(handle.createWallTimer(
        ros::WallDuration(1.0 / rate), [this, work](const ros::WallTimerEvent&) {
          const Outcome outcome = guarded([&] { (this->*work)(); });
          if (!outcome.ok()) ROS_ERROR_THROTTLE(1.0, "deformer_node: %s", outcome.sentence.c_str());
        }));
  };
  if (!parameters.deterministic) every(parameters.cloud_rate, &DeformerNode::publish_cloud);
  every(parameters.marker_rate, &DeformerNode::publish_markers);
  every(parameters.status_rate, &DeformerNode::publish_status);
  diagnostics_.setHardwareID("none");
  diagnostics_.add("deformer", this, &DeformerNode::diagnose);
}

void DeformerNode::take_mesh(const soft_tissue_sim::TetMesh& message) {
  const Outcome outcome = guarded([&] {
    tissue::TetMesh mesh = from_message(message);
    if (mesh.tets.empty()) throw InputError(ErrorCode::kMeshQuality, "mesh: it has no tets");
    std::vector<std::uint8_t> levels = vertex_levels(mesh);
    DisplayMesh display =
        display_mesh(mesh, section_from(parameters_.section_axis, parameters_.section_at),
                     static_cast<std::size_t>(std::max(parameters_.marker_max_triangles, 0)));
    std::shared_ptr<SceneWorker> worker = worker_for(mesh, levels);
    tools_->set_worker(worker, mesh.frame_id);
    simulation_.emplace(
        Simulation{std::move(mesh), std::move(levels), std::move(display), std::move(worker)});
  });
  if (!outcome.ok()) {
    ++rejected_meshes_;
    ROS_ERROR_THROTTLE(1.0, "deformer_node: mesh refused: %s: %s", tissue::name(outcome.code),
                       outcome.sentence.c_str());
    return;
  }
  time_jumps_told_ = 0;
  markers_are_new_ = true;
  ROS_INFO("deformer_node: took mesh %s of %zu tets", simulation_->mesh.uuid.c_str(),
           simulation_->mesh.tets.size());
}

std::shared_ptr<SceneWorker> DeformerNode::worker_for(const tissue::TetMesh& mesh,
                                                      const std::vector<std::uint8_t>& levels) {
  SceneWorkerOptions options;
  options.deterministic = parameters_.deterministic;
  options.playback.tool_timeout = parameters_.tool_timeout;
  options.playback.cloud_rate = parameters_.cloud_rate;
  options.playback.reset_on_time_jump = parameters_.reset_on_time_jump;
  auto body = std::make_shared<const tissue::Body>(tissue::body_of(mesh));
  const auto publish = [this, body, levels, frame = mesh.frame_id](std::int64_t stamp,
                                                                   const tissue::State& state) {
    auto cloud = boost::make_shared<sensor_msgs::PointCloud2>(cloud_message(*body, state, levels));
    cloud->header.frame_id = frame;
    cloud->header.stamp.fromNSec(static_cast<std::uint64_t>(stamp));
    cloud_publisher_.publish(cloud);
  };
  return std::make_shared<SceneWorker>(
      tissue::Scene(scene_, body), options, publish, [](const std::string& sentence) {
        ROS_ERROR_THROTTLE(1.0, "deformer_node: step refused: %s", sentence.c_str());
      });
}

void DeformerNode::publish_cloud() {
  if (!simulation_ || cloud_publisher_.getNumSubscribers() == 0) return;
  SceneWorker& worker = *simulation_->worker;
  const std::int64_t stamp = worker.progress()->stamp;
  auto cloud = boost::make_shared<sensor_msgs::PointCloud2>(
      cloud_message(worker.body(), *worker.state(), simulation_->vertex_levels));
  cloud->header.frame_id = simulation_->mesh.frame_id;
  cloud->header.stamp = ros::Time::now();
  if (stamp != 0) cloud->header.stamp.fromNSec(static_cast<std::uint64_t>(stamp));
  cloud_publisher_.publish(cloud);
}

void DeformerNode::publish_markers() {
  if (!simulation_ || marker_publisher_.getNumSubscribers() == 0) return;
  const std::shared_ptr<const tissue::State> state = simulation_->worker->state();
  const tissue::ToolPoses tools = simulation_->worker->progress()->tools;
  const std::string& frame = simulation_->mesh.frame_id;
  auto markers = level_markers(
      simulation_->display, [&](std::uint32_t v) -> tissue::Vec3 { return state->positions[v]; },
      frame);
  for (std::size_t i = 0; i < tools.size(); ++i) {
    const tissue::ToolDescription& tool = scene_.tools[i];
    markers.markers.push_back(ball_marker(
        tool.name, tools[i] ? tools[i]->position : tissue::Vec3::Zero(), tool.radius, 1.0f, frame));
    if (!tools[i]) markers.markers.back().action = visualization_msgs::Marker::DELETE;
  }
  marker_publisher_.publish(markers_are_new_ ? replacing_all(markers) : markers);
  markers_are_new_ = false;
}

void DeformerNode::publish_status() {
  diagnostics_.update();
  if (!simulation_ || status_publisher_.getNumSubscribers() == 0) return;
  SceneWorker& worker = *simulation_->worker;
  const auto progress = worker.progress();
  soft_tissue_sim::SimulationStatus status =
      to_message(scene_, progress->costs,
                 tissue::deformation_quality(worker.body(), *worker.state()), progress->report);
  status.header.stamp.fromNSec(static_cast<std::uint64_t>(progress->stamp));
  status.header.frame_id = simulation_->mesh.frame_id;
  status.mesh_uuid = simulation_->mesh.uuid;
  status.step_seconds = progress->step_seconds;
  status.dropped_poses = tools_->dropped();
  status.rejected_meshes = rejected_meshes_;
  const tissue::ToolPoses& tools = progress->tools;
  if (!tools.empty() && !any_is_there(tools)) status.flags.push_back("TOOL_LOST");
  if (progress->time_jumps > time_jumps_told_) status.flags.push_back("TIME_JUMP");
  time_jumps_told_ = progress->time_jumps;
  status_publisher_.publish(status);
}

void DeformerNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  if (simulation_) {
    status.summary(DiagnosticStatus::OK, "simulating");
    status.add("mesh", simulation_->mesh.uuid);
  } else {
    status.summary(DiagnosticStatus::WARN, "no mesh");
  }
  status.add("dropped poses", tools_->dropped());
  status.add("rejected meshes", rejected_meshes_);
}

}  // namespace tissue_ros
