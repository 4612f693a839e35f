#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tissue {

/// What one stage of a run cost.
struct StageCost {
  std::string name;
  double cpu_seconds = 0.0;
  double wall_seconds = 0.0;
  /// High-water mark of the program's containers during the stage, above what stood there when the
  /// run began. 0 in a program that is not linked with the memory meter.
  std::size_t peak_bytes = 0;
};

/// What a mesh is made of and what it cost to make.
struct MeshStatistics {
  std::uint64_t initial = 0;
  std::uint64_t tetrahedra = 0;
  std::uint64_t vertices = 0;
  /// Lattice tets by final level.
  std::vector<std::uint64_t> levels;
  /// Tets beyond the sum of 8^level over the levels that the densities wished for: what
  /// conformity costs.
  std::int64_t closure = 0;
  /// d_th(0) to d_th(N−1).
  std::vector<std::uint32_t> thresholds;
  std::uint64_t distinct_densities = 0;
  /// Smallest and largest dihedral angle [rad].
  std::array<double, 2> dihedral = {0.0, 0.0};
  /// Mean and maximum distance of the boundary vertices from the isosurface [m].
  std::array<double, 2> surface_error = {0.0, 0.0};
  std::uint64_t boundary_vertices = 0;
  /// Boundary vertices that stay farther than a tenth of a voxel from the isosurface.
  std::uint64_t boundary_vertices_astray = 0;
  /// Volume inside the boundary [m³].
  double volume = 0.0;
  /// The organ reaches the border of the volume and has been given a cap there.
  bool border_touched = false;
  std::uint64_t components_dropped = 0;
  std::uint64_t vertices_copied = 0;
  std::uint64_t tets_dropped = 0;
  std::uint64_t tets_promoted = 0;
  std::vector<StageCost> stages;
  std::size_t peak_bytes = 0;
};

}  // namespace tissue
