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
    : parameters_(parameters), handle_(handle), diagnostics_(handle, private_handle) {
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
  tools_.resize(scene_.tools.size());
  heard_.resize(scene_.tools.size());
  closed_.resize(scene_.tools.size());
  enabled_.assign(scene_.tools.size(), 1);
  if (!parameters.deterministic) listen_to_tools();

  const auto every = [&](double rate, void (DeformerNode::*work)()) {
    timers_.push_back(handle.createWallTimer(
        ros::WallDuration(1.0 / rate), [this, work](const ros::WallTimerEvent&) {
          const Outcome outcome = guarded([&] { (this->*work)(); });
          if (!outcome.ok()) ROS_ERROR_THROTTLE(1.0, "deformer_node: %s", outcome.sentence.c_str());
        }));
  };
  if (parameters.deterministic) {
    every(10.0, &DeformerNode::finish_replay);
  } else {
    every(parameters.cloud_rate, &DeformerNode::watch_tool);
    every(parameters.cloud_rate, &DeformerNode::publish_cloud);
  }
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
    std::vector<DeviceReader> readers;
    for (const tissue::ToolDescription& tool : scene_.tools) {
      readers.emplace_back(tool, readers.size(), mesh.frame_id, &transforms_);
    }
    simulation_.reset();
    simulation_.emplace(Simulation{std::move(mesh), std::move(levels), std::move(display),
                                   std::move(scene), std::move(readers), std::nullopt});
    if (parameters_.deterministic) replay();
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

void DeformerNode::listen(const std::string& topic, std::function<void(const AnyMessage&)> take) {
  // A live tool's newest pose wins; of a replay each is used.
  constexpr std::uint32_t kAll = 100000;
  tool_subscribers_.push_back(handle_.subscribe<AnyMessage>(
      topic, parameters_.deterministic ? kAll : 1,
      [this, take = std::move(take)](const AnyMessage::ConstPtr& message) {
        if (!simulation_) {
          ROS_WARN_ONCE("deformer_node: no mesh yet, poses are ignored");
          return;
        }
        const Outcome outcome = guarded([&] { take(*message); });
        if (!outcome.ok()) drop_pose(outcome.sentence);
      },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
}

void DeformerNode::listen_to_tools() {
  for (std::size_t i = 0; i < scene_.tools.size(); ++i) {
    const tissue::ToolInput& input = scene_.tools[i].input;
    listen(scene_.tools[i].pose_topic(),
           [this, i](const AnyMessage& message) { take_pose(i, message); });
    const auto take_it = [this, i](const AnyMessage& message) { take_grip(i, message); };
    if (!input.jaw.empty()) listen(input.jaw, take_it);
    if (!input.button.empty()) listen(input.button, take_it);
    if (input.state.empty()) continue;
    listen(input.state, [this, i](const AnyMessage& message) {
      enabled_[i] = simulation_->readers[i].is_enabled(message) ? 1 : 0;
    });
  }
}

void DeformerNode::take_pose(std::size_t tool, const AnyMessage& message) {
  const tissue::ToolSample sample = simulation_->readers[tool].pose(message);
  if (simulation_->playback) {
    heard_[tool] = ros::WallTime::now();
    simulation_->playback->add(sample);
  } else if (enabled_[tool] != 0) {
    move_to(sample);
  }
}

void DeformerNode::take_grip(std::size_t tool, const AnyMessage& message) {
  const auto sample = simulation_->readers[tool].grip(message);
  if (!sample) return;
  if (simulation_->playback) {
    simulation_->playback->add(*sample);
  } else {
    closed_[tool] = sample->closed;
  }
}

void DeformerNode::replay() {
  tissue::PlaybackOptions options;
  options.tool_timeout = parameters_.tool_timeout;
  options.cloud_rate = parameters_.cloud_rate;
  options.reset_on_time_jump = parameters_.reset_on_time_jump;
  simulation_->playback.emplace(
      simulation_->scene, options,
      [this](std::int64_t stamp) {
        stamp_.fromNSec(static_cast<std::uint64_t>(stamp));
        publish_cloud();
      },
      [this](const tissue::StepReport& step, double seconds) { count_step(step, seconds); });
  if (tool_subscribers_.empty()) listen_to_tools();
}

// When a bag is over nothing comes that would push out what waits.
void DeformerNode::finish_replay() {
  const auto is_silent = [](const ros::WallTime& heard) {
    return (ros::WallTime::now() - heard).toSec() > 1.0;
  };
  if (!simulation_ || !simulation_->playback) return;
  if (std::all_of(heard_.begin(), heard_.end(), is_silent)) simulation_->playback->finish();
}

void DeformerNode::count_step(const tissue::StepReport& step, double seconds) {
  last_step_ = step;
  step_seconds_ = seconds;
}

const tissue::ToolPoses& DeformerNode::tools() const {
  return simulation_ && simulation_->playback ? simulation_->playback->tools() : tools_;
}

void DeformerNode::move_to(const tissue::ToolSample& sample) {
  ros::Time stamp;
  stamp.fromNSec(static_cast<std::uint64_t>(sample.stamp));
  // A bag that starts again, or a clock that was set back: the tissue starts again too. Tools of
  // their own clocks may be a little behind each other.
  const ros::Duration behind = stamp_ - stamp;
  if (behind > ros::Duration(tools_.size() > 1 ? parameters_.tool_timeout : 0.0)) {
    if (parameters_.reset_on_time_jump) {
      simulation_->scene.reset();
      simulation_->scene.step(tissue::ToolPoses(tools_.size()), 0.0);
      lose_tools();
    }
    time_jumped_ = true;
    stamp_ = stamp;
  }
  const double dt = has_a_tool() ? std::max(0.0, (stamp - stamp_).toSec()) : 0.0;
  tissue::ToolPoses tools = tools_;
  tools[sample.tool] = sample.pose;
  tools[sample.tool]->closed = closed_[sample.tool];
  const ros::WallTime start = ros::WallTime::now();
  const tissue::StepReport step = simulation_->scene.step(tools, dt);
  count_step(step, (ros::WallTime::now() - start).toSec());
  tools_ = std::move(tools);
  stamp_ = std::max(stamp_, stamp);
  heard_[sample.tool] = ros::WallTime::now();
}

void DeformerNode::lose_tools() { tools_.assign(tools_.size(), std::nullopt); }

bool DeformerNode::has_a_tool() const {
  return std::any_of(tools().begin(), tools().end(), [](const auto& tool) { return bool(tool); });
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
  for (std::size_t i = 0; i < tools().size(); ++i) {
    const tissue::ToolDescription& tool = scene_.tools[i];
    const std::optional<tissue::ToolPose>& pose = tools()[i];
    markers.markers.push_back(ball_marker(tool.name, pose ? pose->position : tissue::Vec3::Zero(),
                                          tool.radius, 1.0f, frame));
    if (!pose) markers.markers.back().action = visualization_msgs::Marker::DELETE;
  }
  marker_publisher_.publish(markers_are_new_ ? replacing_all(markers) : markers);
  markers_are_new_ = false;
}

void DeformerNode::publish_status() {
  diagnostics_.update();
  if (!simulation_ || status_publisher_.getNumSubscribers() == 0) return;
  soft_tissue_sim::SimulationStatus status = to_message(simulation_->scene, last_step_);
  status.header.stamp = stamp_;
  status.header.frame_id = simulation_->mesh.frame_id;
  status.mesh_uuid = simulation_->mesh.uuid;
  status.step_seconds = step_seconds_;
  status.dropped_poses = dropped_poses_;
  status.rejected_meshes = rejected_meshes_;
  if (!tools_.empty() && !has_a_tool()) status.flags.push_back("TOOL_LOST");
  const std::size_t jumps = simulation_->playback ? simulation_->playback->time_jumps() : 0;
  if (time_jumped_ || jumps > time_jumps_told_) status.flags.push_back("TIME_JUMP");
  time_jumped_ = false;
  time_jumps_told_ = jumps;
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
