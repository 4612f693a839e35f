#pragma once

#include "tissue/base/tet_mesh.h"
#include "tissue/field/implicit_surface.h"
#include "tissue/refine/levels.h"

#include <memory>
#include <optional>

namespace tissue {

/// What to make of a volume. The only place where the mesher's defaults stand.
struct MeshOptions {
  /// Values above this are organ, where there is no mask.
  double iso_value = 20.0;
  /// Long edge of the lattice [m]: halving it makes about eight times as many tets. 0: chosen so
  /// that the lattice has about `initial_tetrahedra`.
  double spacing = 0.0;
  /// Tets of the uniform stage (nTinit), met within 2 %. Used where `spacing` is 0.
  std::uint32_t initial_tetrahedra = 40000;
  LevelOptions levels;
  /// Values that map to density 0 and to d_max. Without them: the identity if all values lie in
  /// [0, d_max], else the range inside the organ.
  std::optional<std::array<double, 2>> window;
  /// Keep every component of the organ, not just the largest.
  bool all_components = false;
  /// Stop after the uniform stage.
  bool lattice_only = false;
  /// More tets than this are refused before they are allocated.
  std::uint64_t max_tetrahedra = 100000000;
  /// Threads; 0 means all. The result does not depend on it.
  int threads = 0;
};

/// A mesh, and for the uniform stage what levels came from.
struct BuiltMesh {
  TetMesh mesh;
  /// With `lattice_only`: T_i of each tet (after smoothing), the level of Eq. 6, and the level
  /// after raising (the mesh's own levels are these).
  std::vector<double> lattice_densities;
  std::vector<std::uint8_t> level_wishes;
};

/// From a volume to a conforming mesh, fine where tissue is soft. The organ is where `mask` is set,
/// or without one where the volume exceeds `iso_value`.
///
/// Throws InputError: E_PARAM, E_N, E_NTINIT, E_TOO_MANY_TETS, E_EMPTY_SURFACE, E_TOO_SMALL,
/// E_SIZE_MISMATCH if the mask lies on another grid than the volume.
BuiltMesh build_mesh(const std::shared_ptr<const Volume>& volume,
                     const std::shared_ptr<const Volume>& mask, const MeshOptions& options);

}  // namespace tissue
