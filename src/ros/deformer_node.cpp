#include "ros/deformer_node.h"

#include "ros/convert.h"
#include "ros/markers.h"
#include "ros/pose_input.h"
#include "tissue/simulate/scene_file.h"

#include <sensor_msgs/PointCloud2.h>
#include <soft_tissue_sim/SimulationStatus.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

  cloud_publisher_ = handle.advertise<sensor_msgs::PointCloud2>("deformed_cloud", 2);
  marker_publisher_ = handle.advertise<visualization_msgs::MarkerArray>("deformed_markers", 1);
  status_publisher_ = private_handle.advertise<soft_tissue_sim::SimulationStatus>("status", 1);
  using TetMesh = soft_tissue_sim::TetMesh;
  mesh_subscriber_ = handle.subscribe<TetMesh>(
      "mesh", 1, [this](const TetMesh::ConstPtr& message) { take_mesh(*message); });
  tools_.resize(scene_.tools.size());
  heard_.resize(scene_.tools.size());
  using PoseStamped = geometry_msgs::PoseStamped;
  for (std::size_t i = 0; i < scene_.tools.size(); ++i) {
    pose_subscribers_.push_back(handle.subscribe<PoseStamped>(
        scene_.tools[i].name + "/measured_cp", 1,
        [this, i](const PoseStamped::ConstPtr& pose) { take_pose(i, *pose); }, ros::VoidConstPtr(),
        ros::TransportHints().tcpNoDelay()));
  }

  const auto every = [&](double rate, void (DeformerNode::*work)()) {
    timers_.push_back(handle.createWallTimer(
        ros::WallDuration(1.0 / rate), [this, work](const ros::WallTimerEvent&) {
          const Outcome outcome = guarded([&] { (this->*work)(); });
          if (!outcome.ok()) ROS_ERROR_THROTTLE(1.0, "deformer_node: %s", outcome.sentence.c_str());
        }));
  };
  every(parameters.cloud_rate, &DeformerNode::watch_tool);
  every(parameters.cloud_rate, &DeformerNode::publish_cloud);
  every(parameters.marker_rate, &DeformerNode::publish_markers);
  every(parameters.status_rate, &DeformerNode::publish_status);
  diagnostics_.setHardwareID("none");
  diagnostics_.add("deformer", this, &DeformerNode::diagnose);
}

void DeformerNode::take_mesh(const soft_tissue_sim::TetMesh& message) {
  const Outcome outcome = guarded([&] {
    tissue::TetMesh mesh = from_message(message);
    if (mesh.tets.empty()) throw InputError(ErrorCode::kMeshQuality, "mesh: it has no tets");
    auto body = std::make_shared<const tissue::Body>(tissue::body_of(mesh));
    std::vector<std::uint8_t> levels = vertex_levels(mesh);
    DisplayMesh display =
        display_mesh(mesh, section_from(parameters_.section_axis, parameters_.section_at),
                     static_cast<std::size_t>(std::max(parameters_.marker_max_triangles, 0)));
    tissue::Scene scene(scene_, std::move(body));
    // A solid takes its weight before any tool comes.
    last_step_ = scene.step(tissue::ToolPoses(scene_.tools.size()), 0.0);
    simulation_.emplace(
        Simulation{std::move(mesh), std::move(levels), std::move(display), std::move(scene)});
  });
  if (!outcome.ok()) {
    ++rejected_meshes_;
    ROS_ERROR_THROTTLE(1.0, "deformer_node: mesh refused: %s: %s", tissue::name(outcome.code),
                       outcome.sentence.c_str());
    return;
  }
  lose_tools();
  step_seconds_ = 0.0;
  markers_are_new_ = true;
  ROS_INFO("deformer_node: took mesh %s of %zu tets", simulation_->mesh.uuid.c_str(),
           simulation_->mesh.tets.size());
}

void DeformerNode::take_pose(std::size_t tool, const geometry_msgs::PoseStamped& pose) {
  const Outcome outcome = guarded([&] {
    if (!simulation_) {
      ROS_WARN_ONCE("deformer_node: no mesh yet, poses are ignored");
      return;
    }
    const std::string problem = pose_problem(pose);
    if (!problem.empty()) {
      drop_pose(problem);
      return;
    }
    std::string why_not;
    const auto transformed = pose_in_frame(pose, simulation_->mesh.frame_id, transforms_, why_not);
    if (transformed) {
      move_to(tool, *transformed);
    } else {
      drop_pose(why_not);
    }
  });
  if (!outcome.ok()) drop_pose(outcome.sentence);
}

void DeformerNode::move_to(std::size_t tool, const geometry_msgs::PoseStamped& pose) {
  // A bag that starts again, or a clock that was set back: the tissue starts again too. Tools of
  // their own clocks may be a little behind each other.
  const ros::Duration behind = stamp_ - pose.header.stamp;
  if (behind > ros::Duration(tools_.size() > 1 ? parameters_.tool_timeout : 0.0)) {
    simulation_->scene.reset();
    simulation_->scene.step(tissue::ToolPoses(tools_.size()), 0.0);
    time_jumped_ = true;
    lose_tools();
    stamp_ = pose.header.stamp;
  }
  const double dt = has_a_tool() ? std::max(0.0, (pose.header.stamp - stamp_).toSec()) : 0.0;
  const auto& p = pose.pose.position;
  const auto& q = pose.pose.orientation;
  tissue::ToolPoses tools = tools_;
  tools[tool] = tissue::ToolPose{tissue::Vec3(p.x, p.y, p.z), std::nullopt,
                                 Eigen::Quaterniond(q.w, q.x, q.y, q.z)};
  const ros::WallTime start = ros::WallTime::now();
  last_step_ = simulation_->scene.step(tools, dt);
  step_seconds_ = (ros::WallTime::now() - start).toSec();
  tools_ = std::move(tools);
  stamp_ = std::max(stamp_, pose.header.stamp);
  heard_[tool] = ros::WallTime::now();
}

void DeformerNode::lose_tools() { tools_.assign(tools_.size(), std::nullopt); }

bool DeformerNode::has_a_tool() const {
  return std::any_of(tools_.begin(), tools_.end(), [](const auto& tool) { return bool(tool); });
}

void DeformerNode::drop_pose(const std::string& why) {
  ++dropped_poses_;
  ROS_WARN_THROTTLE(1.0, "deformer_node: pose dropped: %s", why.c_str());
}

void DeformerNode::watch_tool() {
  if (!simulation_) return;
  bool silent = false;
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    if (!tools_[i] || (ros::WallTime::now() - heard_[i]).toSec() <= parameters_.tool_timeout) {
      continue;
    }
    tools_[i].reset();
    silent = true;
  }
  if (!silent && (has_a_tool() || !simulation_->scene.recovering())) return;
  // The first step without a tool lets go; the others relax.
  last_step_ = simulation_->scene.step(tools_, 1.0 / parameters_.cloud_rate);
}

void DeformerNode::publish_cloud() {
  if (!simulation_ || cloud_publisher_.getNumSubscribers() == 0) return;
  const tissue::Scene& scene = simulation_->scene;
  auto cloud = boost::make_shared<sensor_msgs::PointCloud2>(
      cloud_message(scene.body(), scene.state(), simulation_->vertex_levels));
  cloud->header.frame_id = simulation_->mesh.frame_id;
  cloud->header.stamp = stamp_.isZero() ? ros::Time::now() : stamp_;
  cloud_publisher_.publish(cloud);
}

void DeformerNode::publish_markers() {
  if (!simulation_ || marker_publisher_.getNumSubscribers() == 0) return;
  const std::vector<tissue::Vec3>& positions = simulation_->scene.state().positions;
  const std::string& frame = simulation_->mesh.frame_id;
  auto markers = level_markers(
      simulation_->display, [&](std::uint32_t v) -> tissue::Vec3 { return positions[v]; }, frame);
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const tissue::ToolDescription& tool = scene_.tools[i];
    markers.markers.push_back(ball_marker(tool.name,
                                          tools_[i] ? tools_[i]->position : tissue::Vec3::Zero(),
                                          tool.radius, 1.0f, frame));
    if (!tools_[i]) markers.markers.back().action = visualization_msgs::Marker::DELETE;
  }
  marker_publisher_.publish(markers_are_new_ ? replacing_all(markers) : markers);
  markers_are_new_ = false;
}

void DeformerNode::publish_status() {
  diagnostics_.update();
  if (!simulation_ || status_publisher_.getNumSubscribers() == 0) return;
  const tissue::Scene& scene = simulation_->scene;
  const tissue::DeformationQuality quality =
      tissue::deformation_quality(scene.body(), scene.state());
  soft_tissue_sim::SimulationStatus status;
  status.header.stamp = stamp_;
  status.header.frame_id = simulation_->mesh.frame_id;
  status.mesh_uuid = simulation_->mesh.uuid;
  status.scene = scene_.name;
  status.model = tissue::name(scene_.model);
  for (const tissue::EffectCost& cost : scene.effect_costs()) {
    soft_tissue_sim::EffectCost effect;
    effect.name = cost.name;
    effect.seconds = cost.seconds;
    effect.bytes = cost.bytes;
    status.effects.push_back(effect);
  }
  status.step_seconds = step_seconds_;
  status.iterations = static_cast<std::uint32_t>(last_step_.iterations);
  status.residual = last_step_.residual;
  status.solver = last_step_.solver;
  status.energy = last_step_.energy.value_or(std::numeric_limits<double>::quiet_NaN());
  status.min_det_f = quality.min_det_f;
  status.inverted = quality.inverted;
  status.penetration = last_step_.penetration;
  status.moved_vertices = last_step_.moved_vertices;
  status.dropped_poses = dropped_poses_;
  status.rejected_meshes = rejected_meshes_;
  if (last_step_.clamped) status.flags.push_back("CLAMPED");
  if (last_step_.tool_inside) status.flags.push_back("TOOL_INSIDE");
  if (last_step_.not_converged) status.flags.push_back("NOT_CONVERGED");
  if (!tools_.empty() && !has_a_tool()) status.flags.push_back("TOOL_LOST");
  if (time_jumped_) status.flags.push_back("TIME_JUMP");
  time_jumped_ = false;
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
  status.add("dropped poses", dropped_poses_);
  status.add("rejected meshes", rejected_meshes_);
}

}  // namespace tissue_ros
