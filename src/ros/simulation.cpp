#include "ros/simulation.h"

#include "ros/convert.h"
#include "ros/geometry.h"
#include "ros/markers.h"

#include <utility>

namespace tissue_ros {
namespace {

ros::Time time_of(std::int64_t stamp) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(stamp));
  return time;
}

SceneWorkerOptions worker_options(const DeformerNodeParameters& parameters) {
  SceneWorkerOptions options;
  options.deterministic = parameters.deterministic;
  options.playback.tool_timeout = parameters.tool_timeout;
  options.playback.cloud_rate = parameters.cloud_rate;
  options.playback.reset_on_time_jump = parameters.reset_on_time_jump;
  return options;
}

Simulation::Clouds clouds_of(const tissue::TetMesh& mesh, const std::vector<std::uint8_t>& levels,
                             const tissue::Body& body, const tissue::State& state,
                             const std::map<std::string, std::optional<tissue::Vec3>>& probes,
                             const ros::Time& stamp) {
  Simulation::Clouds clouds;
  clouds.cloud = boost::make_shared<sensor_msgs::PointCloud2>(cloud_message(body, state, levels));
  clouds.cloud->header.frame_id = mesh.frame_id;
  clouds.cloud->header.stamp = stamp;
  clouds.probes = boost::make_shared<soft_tissue_sim::Probes>();
  clouds.probes->header = clouds.cloud->header;
  for (const auto& [name, place] : probes) {
    if (!place) continue;
    clouds.probes->names.push_back(name);
    clouds.probes->positions.push_back(point_message(*place));
  }
  return clouds;
}

}  // namespace

Simulation::Simulation(std::shared_ptr<const tissue::TetMesh> mesh,
                       const tissue::SceneDescription& scene,
                       const DeformerNodeParameters& parameters, OnClouds on_clouds,
                       SceneWorker::OnError on_error)
    : mesh_(std::move(mesh)),
      levels_(std::make_shared<const std::vector<std::uint8_t>>(vertex_levels(*mesh_))),
      display_(display_mesh(*mesh_, section_from(parameters.section_axis, parameters.section_at),
                            static_cast<std::size_t>(parameters.marker_max_triangles))) {
  if (mesh_->tets.empty()) {
    throw tissue::InputError(tissue::ErrorCode::kMeshQuality, "mesh: it has no tets");
  }
  const auto on_cloud = [mesh = mesh_, levels = levels_, on_clouds = std::move(on_clouds)](
                            std::int64_t stamp, const tissue::Scene& moved) {
    on_clouds(
        clouds_of(*mesh, *levels, moved.body(), moved.state(), moved.probes(), time_of(stamp)));
  };
  worker_ = std::make_shared<SceneWorker>(
      tissue::Scene(scene, std::make_shared<const tissue::Body>(tissue::body_of(*mesh_))),
      worker_options(parameters), on_cloud, std::move(on_error));
}

Simulation::Clouds Simulation::clouds() const {
  // Under a tool at the rate of a haptic device a step is always about to end.
  const auto view = worker_->next_view(std::chrono::milliseconds(2));
  return clouds_of(*mesh_, *levels_, worker_->body(), view->state, view->probes,
                   view->stamp == 0 ? ros::Time::now() : time_of(view->stamp));
}

visualization_msgs::MarkerArray Simulation::markers() const {
  const auto view = worker_->view();
  const tissue::ToolPoses tools = worker_->progress()->tools;
  auto markers = level_markers(
      display_, [&](std::uint32_t v) -> tissue::Vec3 { return view->state.positions[v]; },
      mesh_->frame_id);
  for (std::size_t i = 0; i < tools.size(); ++i) {
    const tissue::ToolDescription& tool = worker_->description().tools[i];
    markers.markers.push_back(ball_marker(tool.name,
                                          tools[i] ? tools[i]->position : tissue::Vec3::Zero(),
                                          tool.radius, 1.0f, mesh_->frame_id));
    if (!tools[i]) markers.markers.back().action = visualization_msgs::Marker::DELETE;
  }
  return markers;
}

soft_tissue_sim::SimulationStatus Simulation::status() const {
  const auto progress = worker_->progress();
  soft_tissue_sim::SimulationStatus status = to_message(
      worker_->description(), progress->costs,
      tissue::deformation_quality(worker_->body(), worker_->view()->state), progress->report);
  status.header.stamp = time_of(progress->stamp);
  status.header.frame_id = mesh_->frame_id;
  status.mesh_uuid = mesh_->uuid;
  status.step_seconds = progress->step_seconds;
  const tissue::ToolPoses& tools = progress->tools;
  if (!tools.empty() && !any_is_there(tools)) status.flags.push_back("TOOL_LOST");
  if (worker_->is_paused()) status.flags.push_back("PAUSED");
  return status;
}

}  // namespace tissue_ros
