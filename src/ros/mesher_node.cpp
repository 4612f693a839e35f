#include "ros/mesher_node.h"

#include "ros/convert.h"
#include "ros/markers.h"

#include <soft_tissue_sim/TetMesh.h>

namespace tissue_ros {
namespace {

using tissue::ErrorCode;
using tissue::InputError;

tissue::MeshOptions options_from(const soft_tissue_sim::BuildMesh::Request& request,
                                 const MesherNodeParameters& parameters) {
  if (!request.method.empty() && request.method != "density") {
    throw InputError(ErrorCode::kParam,
                     "method: '" + request.method.substr(0, 40) + "' is not density");
  }
  const auto small = [](std::uint32_t value) {
    return static_cast<int>(std::min<std::uint32_t>(value, 1000000));
  };
  tissue::MeshOptions options;
  options.iso_value = request.iso_value;
  options.spacing = request.spacing;
  options.initial_tetrahedra = request.initial_tetrahedra;
  options.levels.sections = small(request.level_sections);
  options.levels.base_level = small(request.base_level);
  options.levels.smooth_levels = small(request.smooth_levels);
  if (request.d_max != 0.0) options.levels.d_max = request.d_max;
  // Not equal also where one of them is not a number, which is then refused by name.
  if (!(request.window_low == request.window_high)) {
    options.window = {{request.window_low, request.window_high}};
  }
  options.all_components = request.all_components;
  options.max_tetrahedra = static_cast<std::uint64_t>(std::max(parameters.max_tetrahedra, 1));
  options.threads = parameters.threads;
  return options;
}

}  // namespace

MesherNode::MesherNode(ros::NodeHandle handle, ros::NodeHandle private_handle,
                       const MesherNodeParameters& parameters)
    : parameters_(parameters), diagnostics_(handle, private_handle) {
  mesh_publisher_ = handle.advertise<soft_tissue_sim::TetMesh>("mesh", 1, true);
  marker_publisher_ = handle.advertise<visualization_msgs::MarkerArray>("mesh_markers", 1, true);
  density_publisher_ =
      handle.advertise<visualization_msgs::MarkerArray>("mesh_density_markers", 1, true);

  using Volume = soft_tissue_sim::Volume;
  mask_subscriber_ = handle.subscribe<Volume>(
      "mask", 1, [this](const Volume::ConstPtr& message) { take_volume(*message, "mask", mask_); });
  volume_subscriber_ = handle.subscribe<Volume>(
      "volume", 1,
      [this](const Volume::ConstPtr& message) { take_volume(*message, "volume", volume_); });

  ros::NodeHandle build_handle(private_handle);
  build_handle.setCallbackQueue(&build_queue_);
  service_ = build_handle.advertiseService("build_mesh", &MesherNode::serve, this);

  diagnostics_.setHardwareID("none");
  diagnostics_.add("mesher", this, &MesherNode::diagnose);
  diagnostics_timer_ = handle.createWallTimer(
      ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_.update(); });
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
  for (std::thread& thread : build_threads_) thread.join();
}

void MesherNode::take_volume(const soft_tissue_sim::Volume& message, const char* name,
                             VolumePtr& slot) {
  const Outcome outcome = guarded([&] {
    auto volume = std::make_shared<const tissue::Volume>(from_message(message));
    const std::lock_guard<std::mutex> lock(volume_mutex_);
    slot = std::move(volume);
  });
  if (!outcome.ok()) {
    report(name, outcome);
    return;
  }
  ROS_INFO("mesher_node: took a %s of %u x %u x %u voxels", name, message.width, message.height,
           message.depth);
  bool ready = false;
  {
    const std::lock_guard<std::mutex> lock(volume_mutex_);
    ready = volume_ != nullptr && (!parameters_.use_mask || mask_ != nullptr);
  }
  if (parameters_.build_on_volume && ready) build_wanted_ = true;
}

bool MesherNode::serve(Request& request, Response& response) {
  const std::unique_lock<std::mutex> lock(build_mutex_, std::try_to_lock);
  const Outcome outcome = lock.owns_lock()
                              ? build(request, response)
                              : Outcome{ErrorCode::kBusy, "build_mesh: a build is running"};
  if (!outcome.ok()) report("build_mesh", outcome);
  response.result = to_message(outcome.code, outcome.sentence);
  // Returning false would lose the response.
  return true;
}

void MesherNode::build_if_wanted() {
  if (!build_wanted_) return;
  const std::unique_lock<std::mutex> lock(build_mutex_, std::try_to_lock);
  // Whoever builds now looks again when it is done.
  if (!lock.owns_lock() || !build_wanted_.exchange(false)) return;
  Response unused;
  const Outcome outcome = guarded([&] {
    const Outcome built = build(request_from_parameters(), unused);
    if (!built.ok()) throw InputError(built.code, built.sentence);
  });
  if (!outcome.ok()) report("build on volume", outcome);
}

Outcome MesherNode::build(const Request& request, Response& response) {
  return guarded([&] {
    VolumePtr volume, mask;
    {
      const std::lock_guard<std::mutex> volume_lock(volume_mutex_);
      volume = volume_;
      mask = request.use_mask ? mask_ : nullptr;
    }
    if (volume == nullptr) {
      throw InputError(ErrorCode::kNoVolume, "build_mesh: no volume has arrived yet");
    }
    if (request.use_mask && mask == nullptr) {
      throw InputError(ErrorCode::kNoVolume, "use_mask: no mask has arrived yet");
    }
    const tissue::TetMesh mesh =
        tissue::build_mesh(volume, mask, options_from(request, parameters_)).mesh;
    publish(mesh);
    ++built_;
    response.statistics = to_message(mesh.statistics);
    if (request.return_mesh) response.mesh = to_message(mesh);
    if (mesh.statistics.distinct_densities == 1) {
      ROS_INFO("mesher_node: 1 distinct value: every tet has the same level");
    }
    ROS_INFO("mesher_node: %zu tets, %zu vertices, mesh %s", mesh.tets.size(), mesh.vertices.size(),
             mesh.uuid.c_str());
  });
}

MesherNode::Request MesherNode::request_from_parameters() const {
  const auto natural = [](const char* name, int value) {
    if (value >= 0) return static_cast<std::uint32_t>(value);
    throw InputError(ErrorCode::kParam,
                     std::string("~") + name + ": " + std::to_string(value) + " is negative");
  };
  Request request;
  request.use_mask = parameters_.use_mask;
  request.iso_value = parameters_.iso_value;
  request.spacing = parameters_.spacing;
  request.initial_tetrahedra = natural("initial_tetrahedra", parameters_.initial_tetrahedra);
  request.level_sections = natural("level_sections", parameters_.level_sections);
  request.base_level = natural("base_level", parameters_.base_level);
  request.smooth_levels = natural("smooth_levels", parameters_.smooth_levels);
  return request;
}

void MesherNode::publish(const tissue::TetMesh& mesh) {
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
                   static_cast<std::size_t>(std::max(parameters_.marker_max_triangles, 0)));
  const auto place = [&](std::uint32_t v) -> tissue::Vec3 {
    return mesh.vertices[v].cast<double>();
  };
  marker_publisher_.publish(replacing_all(level_markers(display, place, mesh.frame_id)));
  density_publisher_.publish(replacing_all(density_markers(display, mesh)));
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
}

}  // namespace tissue_ros
