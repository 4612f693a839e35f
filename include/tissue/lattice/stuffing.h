#pragma once

#include "tissue/base/run.h"
#include "tissue/field/implicit_surface.h"

#include <optional>
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
  /// Boundary triangles, outward.
  std::vector<Triangle> surface;
  /// Length of a long edge [m].
  double spacing = 0.0;
  bool border_touched = false;
  std::size_t components_dropped = 0;
  std::size_t vertices_copied = 0;
  std::size_t tets_dropped = 0;
};

/// Which of the organ's components to keep.
struct Component {
  enum class Choice { kLargest, kAll, kNearest };
  Choice choice = Choice::kLargest;
  /// With kNearest: the component with the inside lattice point nearest to this place in the grid's
  /// frame [m].
  Vec3 place = Vec3::Zero();
};

struct StuffingOptions {
  /// Length of the lattice's long edges [m]: halving it makes about eight times as many tets.
  double spacing = 0.008;
  /// Moves the lattice, in units of its spacing: moves the number of tets a little.
  Vec3 offset = Vec3::Zero();
  Component component;
  /// More lattice points than this are refused before anything is allocated.
  double max_points = 1e9;
};

/// Isosurface stuffing (Labelle and Shewchuk 2007) on the BCC lattice, conforming, with dihedral
/// angles within 10.7° and 164.8°, repaired until its boundary is a closed 2-manifold.
///
/// Throws InputError: E_PARAM for a spacing that is not positive, E_TOO_MANY_TETS for a lattice
/// beyond `max_points`, E_TOO_SMALL, with the spacing that would do, if the organ slips between the
/// points of the lattice.
LatticeMesh stuff(const ImplicitSurface& surface, const StuffingOptions& options,
                  const Run& run = {});

/// The number of tets that stuffing would make before repair, which rarely drops any, at a fraction
/// of the cost. Throws what stuff() throws, but counts 0 where the organ slips through.
std::uint64_t count_stuffed(const ImplicitSurface& surface, const StuffingOptions& options,
                            const Run& run = {});

}  // namespace tissue
