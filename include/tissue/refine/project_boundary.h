#pragma once

#include "tissue/base/run.h"
#include "tissue/base/types.h"
#include "tissue/field/implicit_surface.h"

#include <vector>

namespace tissue {

struct ProjectionOptions {
  /// Rounds in which every boundary vertex moves as far towards the surface as the angles around it
  /// allow; at least 1.
  int sweeps = 4;
  /// Where vertices are held back: inner vertices follow the boundary, and this many sweeps more.
  /// 0: they stay.
  int sweeps_after_following = 2;
};

/// Moves boundary vertices onto the isosurface. A vertex moves all the way if every tet around it
/// keeps its dihedral angles within 10° and 165°, or is not made worse where it is beyond already,
/// else half the way, and so on. Returns 1 for every vertex that has moved. Places are in the
/// grid's frame; `reach` is how far to look for the surface [m].
///
/// Vertices that share no tet move at the same time, in an order that depends on the mesh alone.
std::vector<std::uint8_t> project_boundary(const ImplicitSurface& surface,
                                           std::vector<Vec3f>& vertices,
                                           const std::vector<Tet>& tets,
                                           const std::vector<Triangle>& boundary, double reach,
                                           const ProjectionOptions& options, const Run& run);

}  // namespace tissue
