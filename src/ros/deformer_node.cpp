#include "ros/deformer_node.h"

#include "ros/convert.h"
#include "ros/markers.h"
#include "tissue/base/machine_memory.h"
#include "tissue/base/safe_path.h"
#include "tissue/simulate/scene_file.h"

#include <malloc.h>

#include <utility>

namespace tissue_ros {
namespace {

using tissue::ErrorCode;
using tissue::InputError;

constexpr std::size_t kMaxSceneBytes = 1000000;

bool same_mesh(const tissue::TetMesh& a, const tissue::TetMesh& b) {
  return a.uuid == b.uuid && a.frame_id == b.frame_id && a.vertices == b.vertices &&
         a.tets == b.tets && a.levels == b.levels && a.densities == b.densities &&
         a.tet_densities == b.tet_densities;
}

void add(diagnostic_updater::DiagnosticStatusWrapper& status, const std::string& what,
         const Meter::Reading& reading) {
  status.addf(what + " per second", "%.1f", reading.rate);
  status.addf(what + " median, p99, largest [ms]", "%.3f, %.3f, %.3f", 1e3 * reading.median,
              1e3 * reading.p99, 1e3 * reading.largest);
}

}  // namespace

DeformerNode::DeformerNode(ros::NodeHandle handle, ros::NodeHandle private_handle,
                           const DeformerNodeParameters& parameters)
    : parameters_(parameters),
      handle_(handle),
      kept_(parameters.folder, parameters.keep),
      diagnostics_(handle, private_handle) {
  if (!parameters.scene.empty()) scene_ = tissue::read_scene(parameters.scene);
  advertise(handle, private_handle);
  if (const auto kept = kept_.scene()) {
    const Outcome outcome = guarded([&] { scene_ = tissue::parse_scene(*kept); });
    if (!outcome.ok()) ROS_WARN("deformer_node: scene not kept: %s", outcome.sentence.c_str());
  }
  tools_ = listener_for(scene_);
  if (auto kept = kept_.mesh()) {
    const Outcome outcome = guarded([&] {
      begin(simulation_of(std::make_shared<const tissue::TetMesh>(std::move(*kept)), scene_));
    });
    if (!outcome.ok()) ROS_WARN("deformer_node: mesh not kept: %s", outcome.sentence.c_str());
  }

  diagnostics_.setHardwareID("none");
  diagnostics_.add("deformer", this, &DeformerNode::diagnose);
  // Last: in a nodelet they are called at once, by another thread.
  serve(handle, private_handle);
  const auto every = [&](double rate, void (DeformerNode::*work)()) {
    timers_.push_back(handle.createWallTimer(
        ros::WallDuration(1.0 / rate), [this, work](const ros::WallTimerEvent&) {
          const Outcome outcome = guarded([&] { (this->*work)(); });
          if (!outcome.ok()) ROS_ERROR_THROTTLE(1.0, "deformer_node: %s", outcome.sentence.c_str());
        }));
  };
  if (!parameters.deterministic) every(parameters.cloud_rate, &DeformerNode::publish_clouds);
  every(parameters.marker_rate, &DeformerNode::publish_markers);
  every(parameters.status_rate, &DeformerNode::publish_status);
}

void DeformerNode::advertise(ros::NodeHandle handle, ros::NodeHandle private_handle) {
  // Live, an old cloud is of no use; of a replay, none may be missing.
  const std::uint32_t queue = parameters_.deterministic ? 1000 : 2;
  cloud_publisher_ = handle.advertise<sensor_msgs::PointCloud2>("deformed_cloud", queue);
  marker_publisher_ = handle.advertise<visualization_msgs::MarkerArray>("deformed_markers", 1);
  probe_publisher_ = private_handle.advertise<soft_tissue_sim::Probes>("probes", queue);
  status_publisher_ = private_handle.advertise<soft_tissue_sim::SimulationStatus>("status", 1);
}

void DeformerNode::serve(ros::NodeHandle handle, ros::NodeHandle private_handle) {
  mesh_subscriber_ = handle.subscribe<TetMesh>(
      "mesh", 1, [this](const TetMesh::ConstPtr& message) { take_mesh(*message); });
  services_ = {private_handle.advertiseService("load_scene", &DeformerNode::load_scene, this),
               private_handle.advertiseService("reset", &DeformerNode::reset, this),
               private_handle.advertiseService("pause", &DeformerNode::pause, this)};
}

std::unique_ptr<ToolListener> DeformerNode::listener_for(const tissue::SceneDescription& scene) {
  ToolListenerOptions listening;
  listening.deterministic = parameters_.deterministic;
  listening.tool_timeout = parameters_.tool_timeout;
  listening.force.max_force = parameters_.max_force;
  listening.force.max_rise = parameters_.max_force_rise;
  return std::make_unique<ToolListener>(handle_, scene, listening, transforms_);
}

void DeformerNode::take_mesh(const TetMesh& message) {
  const Outcome outcome = guarded([&] {
    auto mesh = std::make_shared<const tissue::TetMesh>(from_message(message));
    // As a mesher says it again that was started anew.
    if (simulation_ && same_mesh(*mesh, *simulation_->mesh())) return;
    begin(simulation_of(mesh, scene_));
    kept_.keep(std::move(mesh));
  });
  if (outcome.ok()) return;
  ++rejected_meshes_;
  ROS_ERROR_THROTTLE(1.0, "deformer_node: mesh refused: %s: %s", tissue::name(outcome.code),
                     outcome.sentence.c_str());
}

std::unique_ptr<Simulation> DeformerNode::simulation_of(std::shared_ptr<const tissue::TetMesh> mesh,
                                                        const tissue::SceneDescription& scene) {
  return std::make_unique<Simulation>(
      std::move(mesh), scene, parameters_,
      [this](const Simulation::Clouds& clouds) { publish(clouds); },
      [](const std::string& sentence) {
        ROS_ERROR_THROTTLE(1.0, "deformer_node: step refused: %s", sentence.c_str());
      });
}

void DeformerNode::begin(std::unique_ptr<Simulation> simulation) {
  if (simulation_) simulation->worker()->pause(simulation_->worker()->is_paused());
  tools_->set_worker(simulation->worker(), simulation->mesh()->frame_id);
  simulation_ = std::move(simulation);
  // The factors of the last mesh lay in the arenas of threads that have ended.
  malloc_trim(0);
  time_jumps_told_ = 0;
  markers_are_new_ = true;
  ROS_INFO("deformer_node: mesh %s of %zu tets moves as scene '%s' says",
           simulation_->mesh()->uuid.c_str(), simulation_->mesh()->tets.size(),
           scene_.name.c_str());
}

template <class Work>
soft_tissue_sim::Result DeformerNode::result_of(const char* what, const Work& work) {
  const Outcome outcome = guarded(work);
  if (!outcome.ok()) {
    ROS_ERROR_THROTTLE(1.0, "deformer_node: %s refused: %s: %s", what, tissue::name(outcome.code),
                       outcome.sentence.c_str());
  }
  return to_message(outcome.code, outcome.sentence);
}

bool DeformerNode::load_scene(LoadScene::Request& request, LoadScene::Response& response) {
  response.result = result_of("load_scene", [&] {
    if (request.yaml.empty() == request.path.empty()) {
      throw InputError(ErrorCode::kParam, "load_scene: one of yaml and path is to be given");
    }
    const std::string yaml =
        request.path.empty()
            ? request.yaml
            : tissue::scene_text(tissue::confined_path(state_folder(parameters_.folder),
                                                       request.path, /*must_exist=*/true));
    if (yaml.size() > kMaxSceneBytes) {
      throw InputError(ErrorCode::kTooLarge, "load_scene: yaml has " + std::to_string(yaml.size()) +
                                                 " bytes, the limit is " +
                                                 std::to_string(kMaxSceneBytes));
    }
    // All that can fail comes before anything changes.
    tissue::SceneDescription scene = tissue::parse_scene(yaml);
    std::unique_ptr<Simulation> simulation;
    if (simulation_) simulation = simulation_of(simulation_->mesh(), scene);
    tools_ = listener_for(scene);
    scene_ = std::move(scene);
    if (simulation) begin(std::move(simulation));
    kept_.keep_scene(yaml);
  });
  return true;
}

bool DeformerNode::reset(Reset::Request&, Reset::Response& response) {
  response.result = result_of("reset", [&] {
    if (simulation_) simulation_->worker()->reset();
  });
  return true;
}

bool DeformerNode::pause(Pause::Request& request, Pause::Response& response) {
  response.result = result_of("pause", [&] {
    if (!simulation_) throw InputError(ErrorCode::kNoVolume, "pause: there is no mesh yet");
    simulation_->worker()->pause(request.paused != 0);
  });
  return true;
}

void DeformerNode::publish(const Simulation::Clouds& clouds) {
  cloud_publisher_.publish(clouds.cloud);
  probe_publisher_.publish(clouds.probes);
  // The difference of two times may be more than a ros::Duration holds.
  clouds_published_.add(ros::Time::now().toSec() - clouds.cloud->header.stamp.toSec());
}

void DeformerNode::publish_clouds() {
  if (!simulation_) return;
  if (cloud_publisher_.getNumSubscribers() + probe_publisher_.getNumSubscribers() == 0) return;
  publish(simulation_->clouds());
}

void DeformerNode::publish_markers() {
  if (!simulation_ || marker_publisher_.getNumSubscribers() == 0) return;
  const auto markers = simulation_->markers();
  marker_publisher_.publish(markers_are_new_ ? replacing_all(markers) : markers);
  markers_are_new_ = false;
}

void DeformerNode::publish_status() {
  diagnostics_.update();
  if (!simulation_ || status_publisher_.getNumSubscribers() == 0) return;
  soft_tissue_sim::SimulationStatus status = simulation_->status();
  status.dropped_poses = tools_->dropped();
  status.rejected_meshes = rejected_meshes_;
  const std::size_t time_jumps = simulation_->worker()->progress()->time_jumps;
  if (time_jumps > time_jumps_told_) status.flags.push_back("TIME_JUMP");
  time_jumps_told_ = time_jumps;
  status_publisher_.publish(status);
}

void DeformerNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  if (simulation_) {
    SceneWorker& worker = *simulation_->worker();
    const auto progress = worker.progress();
    if (progress->report.not_converged) {
      status.summary(DiagnosticStatus::WARN, "NOT_CONVERGED: the last valid state is shown");
    } else {
      status.summary(DiagnosticStatus::OK, worker.is_paused() ? "paused" : "simulating");
    }
    status.add("mesh", simulation_->mesh()->uuid);
    status.add("scene", scene_.name);
    add(status, "steps", worker.step_meter().read());
    status.add("steps that did not converge", progress->not_converged);
    status.add("iterations", progress->report.iterations);
    status.add("residual", progress->report.residual);
  } else {
    status.summary(DiagnosticStatus::WARN, "no mesh");
  }
  for (std::size_t i = 0; i < scene_.tools.size(); ++i) {
    add(status, "poses of " + scene_.tools[i].name + ", until the force is sent,",
        tools_->meter(i).read());
  }
  add(status, "clouds, since the pose,", clouds_published_.read());
  status.add("dropped poses", tools_->dropped());
  status.add("rejected meshes", rejected_meshes_);
  status.add("resident memory [MB]", tissue::resident_memory() / 1000000);
  status.add("allocated memory [kB]", tissue::allocated_memory() / 1000);
}

}  // namespace tissue_ros
