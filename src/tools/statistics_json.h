#pragma once

#include "tissue/base/mesh_statistics.h"

#include <nlohmann/json.hpp>

namespace tissue {

/// The figures of a mesh as `--stats` writes them.
inline nlohmann::json to_json(const MeshStatistics& statistics) {
  constexpr double kDegrees = 180.0 / 3.14159265358979323846;
  nlohmann::json stages = nlohmann::json::array();
  for (const StageCost& stage : statistics.stages) {
    stages.push_back({{"name", stage.name},
                      {"cpu_seconds", stage.cpu_seconds},
                      {"wall_seconds", stage.wall_seconds},
                      {"peak_bytes", stage.peak_bytes}});
  }
  return {{"initial", statistics.initial},
          {"tetrahedra", statistics.tetrahedra},
          {"vertices", statistics.vertices},
          {"closure", statistics.closure},
          {"levels", statistics.levels},
          {"thresholds", statistics.thresholds},
          {"distinct_densities", statistics.distinct_densities},
          {"dihedral_deg", {statistics.dihedral[0] * kDegrees, statistics.dihedral[1] * kDegrees}},
          {"surface_error_m", statistics.surface_error},
          {"boundary_vertices", statistics.boundary_vertices},
          {"boundary_vertices_astray", statistics.boundary_vertices_astray},
          {"volume_m3", statistics.volume},
          {"border_touched", statistics.border_touched},
          {"components_dropped", statistics.components_dropped},
          {"vertices_copied", statistics.vertices_copied},
          {"tets_dropped", statistics.tets_dropped},
          {"tets_promoted", statistics.tets_promoted},
          {"stages", stages},
          {"peak_bytes", statistics.peak_bytes}};
}

}  // namespace tissue
