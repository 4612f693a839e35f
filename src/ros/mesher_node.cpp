#include "ros/mesher_node.h"

#include "ros/build_request.h"
#include "ros/convert.h"
#include "ros/markers.h"
#include "ros/point_file.h"
#include "tissue/base/machine_memory.h"
#include "tissue/base/mesh_file.h"
#include "tissue/base/safe_path.h"
#include "tissue/field/triangle_surface.h"

#include <soft_tissue_sim/TetMesh.h>

#include <filesystem>
#include <utility>

namespace tissue_ros {

using tissue::ErrorCode;
using tissue::InputError;

MesherNode::MesherNode(ros::NodeHandle handle, ros::NodeHandle private_handle,
                       const MesherNodeParameters& parameters)
    : parameters_(parameters),
      kept_(parameters.folder, parameters.keep),
      diagnostics_(handle, private_handle) {
  mesh_publisher_ = handle.advertise<soft_tissue_sim::TetMesh>("mesh", 1, true);
  marker_publisher_ = handle.advertise<visualization_msgs::MarkerArray>("mesh_markers", 1, true);
  density_publisher_ =
      handle.advertise<visualization_msgs::MarkerArray>("mesh_density_markers", 1, true);

  ros::NodeHandle build_handle(private_handle);
  build_handle.setCallbackQueue(&build_queue_);
  services_ = {build_handle.advertiseService("build_mesh", &MesherNode::serve, this),
               build_handle.advertiseService("save_mesh", &MesherNode::save, this),
               build_handle.advertiseService("load_mesh", &MesherNode::load, this)};
  action_ = std::make_unique<ActionServer>(
      build_handle, "build", [this](const Goal& goal) { take_goal(goal); },
      [this](const Goal& goal) { cancel(goal); }, false);
  action_->start();
  if (auto kept = kept_.mesh()) {
    const auto mesh = std::make_shared<const tissue::TetMesh>(std::move(*kept));
    const Outcome outcome = guarded([&] { publish(mesh); });
    has_kept_mesh_ = outcome.ok();
    if (!outcome.ok()) report("kept mesh", outcome);
  }
  diagnostics_.setHardwareID("none");
  diagnostics_.add("mesher", this, &MesherNode::diagnose);
  diagnostics_timer_ = handle.createWallTimer(
      ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_.update(); });
  using Volume = soft_tissue_sim::Volume;
  mask_subscriber_ = handle.subscribe<Volume>(
      "mask", 1, [this](const Volume::ConstPtr& message) { take_volume(*message, "mask", mask_); });
  volume_subscriber_ = handle.subscribe<Volume>(
      "volume", 1,
      [this](const Volume::ConstPtr& message) { take_volume(*message, "volume", volume_); });
  for (int i = 0; i < 2; ++i) {
    build_threads_.emplace_back([this] {
      while (!ending_) {
        build_queue_.callOne(ros::WallDuration(0.1));
        build_if_wanted();
      }
    });
  }
}

MesherNode::~MesherNode() {
  ending_ = true;
  *node_ending_ = true;
  for (std::thread& thread : build_threads_) thread.join();
  // No goal can come any more.
  *goal_cancelled_ = true;
  if (pursuit_.joinable()) pursuit_.join();
}

void MesherNode::take_volume(const soft_tissue_sim::Volume& message, const char* name,
                             VolumePtr& slot) {
  const Outcome outcome = guarded([&] {
    auto volume = std::make_shared<const tissue::Volume>(from_message(message));
    const std::lock_guard<std::mutex> lock(data_mutex_);
    slot = std::move(volume);
  });
  if (!outcome.ok()) return report(name, outcome);
  ROS_INFO("mesher_node: took a %s of %u x %u x %u voxels", name, message.width, message.height,
           message.depth);
  bool ready = false;
  {
    const std::lock_guard<std::mutex> lock(data_mutex_);
    ready = volume_ != nullptr && (!parameters_.use_mask || mask_ != nullptr);
  }
  if (!parameters_.build_on_volume || !ready) return;
  // The first is the one that the kept mesh is of.
  if (!std::exchange(has_kept_mesh_, false)) build_wanted_ = true;
}

template <class Work>
soft_tissue_sim::Result MesherNode::result_of(const char* what, const Work& work) {
  const Outcome outcome = guarded(work);
  if (!outcome.ok()) report(what, outcome);
  return to_message(outcome.code, outcome.sentence);
}

tissue::Run MesherNode::run_until(Token cancelled) const {
  tissue::Run run;
  run.threads = parameters_.threads;
  run.cancelled = std::move(cancelled);
  return run;
}

bool MesherNode::serve(Request& request, Response& response) {
  build(request, response, run_until(node_ending_));
  // Returning false would lose the response.
  return true;
}

void MesherNode::take_goal(Goal goal) {
  if (pursuing_.exchange(true)) {
    soft_tissue_sim::BuildMeshResult busy;
    busy.result = to_message(ErrorCode::kBusy, "build: a build is running");
    goal.setRejected(busy, busy.result.message);
    return;
  }
  // roscpp delivers the next goal only after this returns.
  if (pursuit_.joinable()) pursuit_.join();
  tissue::Run run = run_until(std::make_shared<std::atomic<bool>>(false));
  {
    const std::lock_guard<std::mutex> lock(goal_mutex_);
    goal_cancelled_ = run.cancelled;
  }
  goal.setAccepted();
  run.report = [goal](const tissue::Progress& progress) mutable {
    soft_tissue_sim::BuildMeshFeedback feedback;
    feedback.stage = progress.stage;
    feedback.fraction = progress.fraction;
    feedback.tetrahedra = progress.tetrahedra;
    goal.publishFeedback(feedback);
  };
  pursuit_ = std::thread([this, goal, run] {
    pursue(goal, run);
    pursuing_ = false;
  });
}

void MesherNode::pursue(Goal goal, const tissue::Run& run) {
  soft_tissue_sim::BuildMeshResult result;
  build(*goal.getGoal(), result, run);
  const std::string& sentence = result.result.message;
  switch (static_cast<ErrorCode>(result.result.code)) {
    case ErrorCode::kOk: goal.setSucceeded(result, sentence); break;
    case ErrorCode::kCancelled: goal.setCanceled(result, sentence); break;
    default: goal.setAborted(result, sentence);
  }
}

void MesherNode::cancel(Goal goal) {
  const actionlib_msgs::GoalStatus status = goal.getGoalStatus();
  // The one goal that is being pursued; others have been answered already.
  if (status.status != actionlib_msgs::GoalStatus::PREEMPTING) return;
  const std::lock_guard<std::mutex> lock(goal_mutex_);
  *goal_cancelled_ = true;
}

void MesherNode::build_if_wanted() {
  if (!build_wanted_) return;
  {
    const std::unique_lock<std::mutex> lock(build_mutex_, std::try_to_lock);
    // Whoever builds now looks again when it is done.
    if (!lock.owns_lock() || !build_wanted_.exchange(false)) return;
  }
  Response unused;
  const Outcome outcome =
      guarded([&] { build(request_from(parameters_), unused, run_until(node_ending_)); });
  if (!outcome.ok()) report("build on volume", outcome);
  // Somebody was faster: the wish stands.
  if (unused.result.code == soft_tissue_sim::Result::E_BUSY) build_wanted_ = true;
}

template <class Asked, class Answer>
void MesherNode::build(const Asked& request, Answer& answer, const tissue::Run& run) {
  answer.result = result_of("build_mesh", [&] {
    const std::unique_lock<std::mutex> lock(build_mutex_, std::try_to_lock);
    if (!lock.owns_lock()) throw InputError(ErrorCode::kBusy, "build_mesh: a build is running");
    const auto mesh = std::make_shared<const tissue::TetMesh>(mesh_for(request, run));
    run.go_on();
    publish(mesh);
    ++built_;
    answer.statistics = to_message(mesh->statistics);
    if (request.return_mesh) answer.mesh = to_message(*mesh);
    if (mesh->statistics.distinct_densities == 1) {
      ROS_INFO("mesher_node: 1 distinct value: every tet has the same level");
    }
    ROS_INFO("mesher_node: %zu tets, %zu vertices, mesh %s", mesh->tets.size(),
             mesh->vertices.size(), mesh->uuid.c_str());
  });
}

template <class Asked>
tissue::TetMesh MesherNode::mesh_for(const Asked& request, const tissue::Run& run) const {
  VolumePtr volume, mask;
  {
    const std::lock_guard<std::mutex> lock(data_mutex_);
    volume = volume_;
    mask = request.use_mask ? mask_ : nullptr;
  }
  if (volume == nullptr) {
    throw InputError(ErrorCode::kNoVolume, "build_mesh: no volume has arrived yet");
  }
  if (request.use_mask && mask == nullptr) {
    throw InputError(ErrorCode::kNoVolume, "use_mask: no mask has arrived yet");
  }
  const tissue::MeshOptions options = options_from(request, parameters_);
  if (request.use_mask && !request.surface_file.empty()) {
    throw InputError(ErrorCode::kParam, "surface_file: use_mask is set too; one is the organ");
  }
  const std::string below = state_folder(parameters_.folder);
  const auto file = [&](const std::string& name) {
    return tissue::confined_path(below, name, true);
  };
  if (options.method == tissue::Method::kWished) {
    return build_strain_mesh(volume, surface_for(request, volume, mask, file), options,
                             motion_from(request, file), run)
        .mesh;
  }
  if (request.surface_file.empty()) return tissue::build_mesh(volume, mask, options, run).mesh;
  return tissue::build_mesh(volume, surface_for(request, volume, mask, file), options, run).mesh;
}

bool MesherNode::save(FileRequest& request, FileResponse& response) {
  response.result = result_of("save_mesh", [&] {
    MeshPtr mesh;
    {
      const std::lock_guard<std::mutex> lock(data_mutex_);
      mesh = mesh_;
    }
    const std::string path =
        tissue::confined_path(state_folder(parameters_.folder), request.path, false);
    if (mesh == nullptr) {
      throw InputError(ErrorCode::kNoVolume, "save_mesh: there is no mesh yet");
    }
    if (std::filesystem::path(path).extension() == ".pcd") {
      write_points(*mesh, path);
    } else {
      tissue::write_mesh(*mesh, path);
    }
    response.uuid = mesh->uuid;
  });
  return true;
}

bool MesherNode::load(FileRequest& request, FileResponse& response) {
  response.result = result_of("load_mesh", [&] {
    const std::string path =
        tissue::confined_path(state_folder(parameters_.folder), request.path, true);
    const auto mesh =
        std::make_shared<const tissue::TetMesh>(tissue::read_mesh(path, /*only_own=*/true));
    publish(mesh);
    response.uuid = mesh->uuid;
  });
  return true;
}

void MesherNode::publish(const MeshPtr& built) {
  const std::lock_guard<std::mutex> one_at_a_time(publish_mutex_);
  const tissue::TetMesh& mesh = *built;
  auto message = boost::make_shared<soft_tissue_sim::TetMesh>(to_message(mesh));
  if (ros::serialization::serializationLength(*message) > kMaxMessageBytes) {
    throw InputError(ErrorCode::kTooLarge, "mesh: " + std::to_string(mesh.tets.size()) +
                                               " tets do not fit into one message; mesh the file "
                                               "with mesh_volume");
  }
  message->header.stamp = ros::Time::now();
  mesh_publisher_.publish(message);
  const DisplayMesh display =
      display_mesh(mesh, section_from(parameters_.section_axis, parameters_.section_at),
                   static_cast<std::size_t>(parameters_.marker_max_triangles));
  const auto place = [&](std::uint32_t v) -> tissue::Vec3 {
    return mesh.vertices[v].cast<double>();
  };
  marker_publisher_.publish(replacing_all(level_markers(display, place, mesh.frame_id)));
  density_publisher_.publish(replacing_all(density_markers(display, mesh)));
  kept_.keep(built);
  const std::lock_guard<std::mutex> lock(data_mutex_);
  mesh_ = built;
}

void MesherNode::report(const char* what, const Outcome& outcome) {
  ++rejected_;
  ROS_ERROR_THROTTLE(1.0, "mesher_node: %s refused: %s: %s", what, tissue::name(outcome.code),
                     outcome.sentence.c_str());
}

void MesherNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "serving");
  status.add("meshes built", built_.load());
  status.add("requests and volumes rejected", rejected_.load());
  status.add("resident memory [MB]", tissue::resident_memory() / 1000000);
  status.add("allocated memory [kB]", tissue::allocated_memory() / 1000);
}

}  // namespace tissue_ros
