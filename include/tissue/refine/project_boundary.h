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

/// Tets from number `begin` to `end` − 1.
struct TetRange {
  std::size_t begin, end;
};

/// Moves boundary vertices onto the isosurface. A vertex moves all the way if every tet around it
/// keeps its dihedral angles within 10° and 165°, or is not made worse where it is beyond already,
/// else half the way, and so on. Returns 1 for every vertex that has moved. Places are in the
/// grid's frame; `reach` is how far to look for the surface [m].
///
/// `near` holds, ascending, all tets that have a corner on the boundary and perhaps others: where
/// to look for them. Vertices that share no tet move at the same time, in an order that depends on
/// the mesh alone.
std::vector<std::uint8_t> project_boundary(const ImplicitSurface& surface,
                                           std::vector<Vec3f>& vertices,
                                           const std::vector<Tet>& tets,
                                           const std::vector<Triangle>& boundary,
                                           const std::vector<TetRange>& near, double reach,
                                           const ProjectionOptions& options, const Run& run);

/// The parts of lattice tets with a corner on the boundary: no other part has one. Lattice tet t
/// consists of tets first_tet[t] to first_tet[t + 1] − 1; vertices below `lattice_vertices` are the
/// lattice's.
std::vector<TetRange> tets_near_boundary(const std::vector<Tet>& lattice_tets,
                                         const std::vector<std::size_t>& first_tet,
                                         const std::vector<Triangle>& boundary,
                                         std::uint32_t lattice_vertices);

}  // namespace tissue
