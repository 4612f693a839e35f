#pragma once

#include "tissue/field/implicit_surface.h"

#include <vector>

namespace tissue {

/// The uniform stage: an organ filled with tets of one size.
struct LatticeMesh {
  /// Places in the grid's frame [m].
  std::vector<Vec3> vertices;
  /// Positive volumes. Where a tet is whole, its long edges are (0, 2) and (1, 3).
  std::vector<Tet> tets;
  /// 1 for a tet with the lattice's own shape, 0 for one that was cut or warped at the boundary.
  std::vector<std::uint8_t> whole;
  /// Length of a long edge [m].
  double spacing = 0.0;
  bool border_touched = false;
  std::size_t components_dropped = 0;
  std::size_t vertices_copied = 0;
  std::size_t tets_dropped = 0;
};

struct StuffingOptions {
  /// Length of the lattice's long edges [m]: halving it makes about eight times as many tets.
  double spacing = 0.008;
  /// Keep every component instead of the one with the most tets.
  bool all_components = false;
  /// More lattice points than this are refused before anything is allocated.
  double max_points = 1e9;
};

/// Isosurface stuffing (Labelle and Shewchuk 2007) on the BCC lattice, conforming, with dihedral
/// angles within 10.7° and 164.8°, repaired until its boundary is a closed 2-manifold.
///
/// Throws InputError: E_PARAM for a spacing that is not positive, E_TOO_MANY_TETS for a lattice
/// beyond `max_points`, E_TOO_SMALL, with the spacing that would do, if the organ slips between the
/// points of the lattice.
LatticeMesh stuff(const ImplicitSurface& surface, const StuffingOptions& options);

}  // namespace tissue
