#include "ros/convert.h"

#include "ros/geometry.h"
#include "tissue/base/check_mesh.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace tissue_ros {
namespace {

using tissue::ErrorCode;
using tissue::InputError;

// Groups of N numbers, as the flat arrays of messages hold them.
template <class Item, class Number>
std::vector<Item> grouped(const std::string& field, const std::vector<Number>& flat) {
  constexpr std::size_t kGroup = sizeof(Item) / sizeof(Number);
  if (flat.size() % kGroup != 0) {
    throw InputError(ErrorCode::kSizeMismatch,
                     "mesh: " + field + " has " + std::to_string(flat.size()) +
                         " entries, not a multiple of " + std::to_string(kGroup));
  }
  std::vector<Item> items(flat.size() / kGroup);
  if (!flat.empty()) {
    std::memcpy(static_cast<void*>(items.data()), flat.data(), flat.size() * sizeof(Number));
  }
  return items;
}

template <class Number, class Item>
std::vector<Number> flat(const std::vector<Item>& items) {
  std::vector<Number> numbers(items.size() * (sizeof(Item) / sizeof(Number)));
  if (!items.empty()) {
    std::memcpy(numbers.data(), static_cast<const void*>(items.data()),
                items.size() * sizeof(Item));
  }
  return numbers;
}

}  // namespace

tissue::Volume from_message(const soft_tissue_sim::Volume& message) {
  const auto& pose = message.origin;
  tissue::RawVolume raw;
  raw.size = {message.width, message.height, message.depth};
  raw.spacing = tissue::Vec3(message.spacing.x, message.spacing.y, message.spacing.z);
  raw.origin = tissue::Vec3(pose.position.x, pose.position.y, pose.position.z);
  raw.orientation = {pose.orientation.x, pose.orientation.y, pose.orientation.z,
                     pose.orientation.w};
  raw.encoding = message.encoding;
  raw.is_bigendian = message.is_bigendian != 0;
  raw.slope = message.rescale_slope == 0.0 ? 1.0 : message.rescale_slope;
  raw.intercept = message.rescale_intercept;
  raw.quantity = message.quantity;
  raw.frame_id = plain_frame(message.header.frame_id);
  raw.data = message.data.data();
  raw.data_size = message.data.size();
  return tissue::decode_volume(raw);
}

soft_tissue_sim::Volume to_message(const tissue::Volume& volume) {
  soft_tissue_sim::Volume message;
  message.header.frame_id = volume.frame_id;
  message.width = volume.grid.size[0];
  message.height = volume.grid.size[1];
  message.depth = volume.grid.size[2];
  message.spacing = vector_message(volume.grid.spacing);
  message.origin.position = point_message(volume.grid.origin);
  message.origin.orientation = quaternion_message(Eigen::Quaterniond(volume.grid.axes));
  message.encoding = tissue::encoding_name(volume.voxels);
  message.rescale_slope = volume.slope;
  message.rescale_intercept = volume.intercept;
  message.quantity = tissue::quantity_name(volume.quantity);
  std::visit(
      [&](const auto& values) {
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
        message.data.assign(bytes, bytes + values.size() * sizeof(values[0]));
      },
      volume.voxels);
  return message;
}

tissue::TetMesh from_message(const soft_tissue_sim::TetMesh& message) {
  if (message.tetrahedra.size() / 4 > kMaxMeshTets) {
    throw InputError(ErrorCode::kTooLarge,
                     "mesh: tetrahedra holds " + std::to_string(message.tetrahedra.size() / 4) +
                         " tets, the limit is " + std::to_string(kMaxMeshTets));
  }
  tissue::TetMesh mesh;
  mesh.frame_id = plain_frame(message.header.frame_id);
  if (mesh.frame_id.empty() || mesh.frame_id.size() > kMaxNameLength) {
    throw InputError(ErrorCode::kFrame, "mesh: header.frame_id is empty or too long");
  }
  if (message.uuid.size() > kMaxNameLength) {
    throw InputError(ErrorCode::kTooLarge, "mesh: uuid is too long");
  }
  mesh.vertices = grouped<tissue::Vec3f>("vertices", message.vertices);
  mesh.tets = grouped<tissue::Tet>("tetrahedra", message.tetrahedra);
  mesh.surface = grouped<tissue::Triangle>("surface", message.surface);
  mesh.parents = grouped<tissue::Edge>("parents", message.parents);
  mesh.levels = message.levels;
  mesh.densities = message.densities;
  mesh.tet_densities = message.tet_densities;
  mesh.lattice_vertices = message.lattice_vertices;
  tissue::check_mesh(mesh);
  if (mesh.surface.empty()) mesh.surface = tissue::boundary_of(mesh.tets, mesh.vertices.size());
  mesh.uuid = message.uuid.empty() ? tissue::mesh_uuid(mesh) : message.uuid;
  return mesh;
}

soft_tissue_sim::TetMesh to_message(const tissue::TetMesh& mesh) {
  soft_tissue_sim::TetMesh message;
  message.header.frame_id = mesh.frame_id;
  message.uuid = mesh.uuid;
  message.vertices = flat<float>(mesh.vertices);
  message.tetrahedra = flat<std::uint32_t>(mesh.tets);
  message.levels = mesh.levels;
  message.densities = mesh.densities;
  message.tet_densities = mesh.tet_densities;
  message.surface = flat<std::uint32_t>(mesh.surface);
  message.parents = flat<std::uint32_t>(mesh.parents);
  message.lattice_vertices = mesh.lattice_vertices;
  message.statistics = to_message(mesh.statistics);
  return message;
}

soft_tissue_sim::MeshStatistics to_message(const tissue::MeshStatistics& statistics) {
  soft_tissue_sim::MeshStatistics message;
  message.initial = statistics.initial;
  message.tetrahedra = statistics.tetrahedra;
  message.vertices = statistics.vertices;
  message.levels = statistics.levels;
  message.closure = statistics.closure;
  message.thresholds = statistics.thresholds;
  message.distinct_densities = statistics.distinct_densities;
  message.min_dihedral = statistics.dihedral[0];
  message.max_dihedral = statistics.dihedral[1];
  message.surface_error_mean = statistics.surface_error[0];
  message.surface_error_max = statistics.surface_error[1];
  message.boundary_vertices = statistics.boundary_vertices;
  message.boundary_vertices_astray = statistics.boundary_vertices_astray;
  message.volume = statistics.volume;
  message.border_touched = statistics.border_touched;
  message.components_dropped = statistics.components_dropped;
  message.vertices_copied = statistics.vertices_copied;
  message.tets_dropped = statistics.tets_dropped;
  message.tets_promoted = statistics.tets_promoted;
  message.peak_bytes = statistics.peak_bytes;
  for (const tissue::StageCost& stage : statistics.stages) {
    soft_tissue_sim::StageCost cost;
    cost.name = stage.name;
    cost.cpu_seconds = stage.cpu_seconds;
    cost.wall_seconds = stage.wall_seconds;
    cost.peak_bytes = stage.peak_bytes;
    message.stages.push_back(cost);
  }
  return message;
}

soft_tissue_sim::Result to_message(ErrorCode code, const std::string& sentence) {
  soft_tissue_sim::Result result;
  result.code = static_cast<std::uint8_t>(code);
  result.message = sentence;
  return result;
}

sensor_msgs::PointCloud2 cloud_message(const tissue::Body& body, const tissue::State& state,
                                       const std::vector<std::uint8_t>& levels) {
  constexpr std::array<const char*, 6> kFields = {"x",       "y",     "z",
                                                  "density", "level", "displacement"};
  constexpr std::uint32_t kPointStep = kFields.size() * sizeof(float);
  sensor_msgs::PointCloud2 cloud;
  for (std::uint32_t i = 0; i < kFields.size(); ++i) {
    sensor_msgs::PointField field;
    field.name = kFields[i];
    field.offset = i * sizeof(float);
    field.datatype = sensor_msgs::PointField::FLOAT32;
    field.count = 1;
    cloud.fields.push_back(field);
  }
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(state.positions.size());
  cloud.point_step = kPointStep;
  cloud.row_step = cloud.width * kPointStep;
  cloud.is_dense = true;
  cloud.data.resize(cloud.row_step);
  for (std::size_t v = 0; v < state.positions.size(); ++v) {
    const tissue::Vec3f place = state.positions[v].cast<float>();
    const double moved = (state.positions[v] - body.rest[v].cast<double>()).norm();
    const float point[kFields.size()] = {place.x(),
                                         place.y(),
                                         place.z(),
                                         body.densities[v],
                                         static_cast<float>(levels[v]),
                                         static_cast<float>(moved)};
    std::memcpy(&cloud.data[v * kPointStep], point, kPointStep);
  }
  return cloud;
}

std::vector<tissue::Vec3f> places_in(const sensor_msgs::PointCloud2& cloud) {
  constexpr std::array<const char*, 3> kNames = {"x", "y", "z"};
  for (std::uint32_t i = 0; i < kNames.size(); ++i) {
    const bool is_there = cloud.fields.size() > i && cloud.fields[i].name == kNames[i] &&
                          cloud.fields[i].datatype == sensor_msgs::PointField::FLOAT32 &&
                          cloud.fields[i].offset == i * sizeof(float);
    if (!is_there || cloud.is_bigendian || cloud.point_step < sizeof(tissue::Vec3f)) {
      throw InputError(ErrorCode::kEncoding, "fields: do not begin with x, y, z in float32");
    }
  }
  const std::size_t count = std::size_t{cloud.width} * cloud.height;
  if (cloud.data.size() / cloud.point_step < count) {
    throw InputError(ErrorCode::kSizeMismatch, "data: " + std::to_string(cloud.data.size()) +
                                                   " bytes are too few for " +
                                                   std::to_string(count) + " points");
  }
  std::vector<tissue::Vec3f> places(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(places[i].data(), &cloud.data[i * cloud.point_step], sizeof(tissue::Vec3f));
    if (!places[i].allFinite()) {
      throw InputError(ErrorCode::kNonfinite,
                       "data: point " + std::to_string(i) + " is not finite");
    }
  }
  return places;
}

std::vector<std::uint8_t> vertex_levels(const tissue::TetMesh& mesh) {
  std::vector<std::uint8_t> levels(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (const std::uint32_t v : mesh.tets[t]) levels[v] = std::max(levels[v], mesh.levels[t]);
  }
  return levels;
}

std::string plain_frame(const std::string& frame_id) {
  return !frame_id.empty() && frame_id[0] == '/' ? frame_id.substr(1) : frame_id;
}

soft_tissue_sim::SimulationStatus to_message(const tissue::SceneDescription& scene,
                                             const std::vector<tissue::EffectCost>& costs,
                                             const tissue::DeformationQuality& quality,
                                             const tissue::StepReport& last_step) {
  soft_tissue_sim::SimulationStatus status;
  status.scene = scene.name;
  status.model = tissue::name(scene.model);
  for (const tissue::EffectCost& cost : costs) {
    soft_tissue_sim::EffectCost effect;
    effect.name = cost.name;
    effect.seconds = cost.seconds;
    effect.bytes = cost.bytes;
    status.effects.push_back(effect);
  }
  status.iterations = static_cast<std::uint32_t>(last_step.iterations);
  status.residual = last_step.residual;
  status.solver = last_step.solver;
  status.energy = last_step.energy.value_or(std::numeric_limits<double>::quiet_NaN());
  status.min_det_f = quality.min_det_f;
  status.inverted = quality.inverted;
  status.penetration = last_step.penetration;
  status.moved_vertices = last_step.moved_vertices;
  if (last_step.clamped) status.flags.push_back("CLAMPED");
  if (last_step.tool_inside) status.flags.push_back("TOOL_INSIDE");
  if (last_step.not_converged) status.flags.push_back("NOT_CONVERGED");
  if (last_step.folded) status.flags.push_back("FOLDED");
  return status;
}

}  // namespace tissue_ros
