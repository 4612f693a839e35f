#pragma once

#include "tissue/base/run.h"
#include "tissue/lattice/bcc_lattice.h"
#include "tissue/lattice/stuffing.h"

#include <vector>

namespace tissue {

/// What a lattice point is to the surface.
enum PointState : std::int8_t {
  kInside = -1,
  /// Exactly on the surface, where the lattice has it.
  kOn = 0,
  kOutside = 1,
  /// Moved onto the surface.
  kWarped = 2,
};

/// The lattice with what the surface does to it. Points and cuts that become vertices are numbered
/// in the order of the points, the cuts of a point after it in the order of their directions, so
/// that nothing is searched and every layer of points can be worked on by itself.
struct CutLattice {
  BccLattice lattice;
  /// Difference of the numbers of a point of either parity and the end of its edges.
  std::array<std::array<std::int64_t, BccLattice::kDirections>, 2> offsets;
  std::vector<PointState> states;
  /// Bit d: there is a cut on the edge in direction d. Bit 7: the point itself is a vertex.
  std::vector<std::uint8_t> marks;
  static constexpr std::uint8_t kVertexMark = 0x80;
  /// Number of the first vertex at or after each point.
  std::vector<std::uint32_t> first_vertex;
  /// Places of the vertices in the grid's frame [m].
  std::vector<Vec3> vertices;
  /// 1 for vertices on the surface.
  std::vector<std::uint8_t> on_surface;
  bool border_touched = false;
  std::size_t components_dropped = 0;

  std::uint32_t vertex_at(std::int64_t point) const { return first_vertex[point]; }
  std::uint32_t vertex_at_cut(std::int64_t start, int direction) const {
    const unsigned before = marks[start] & (kVertexMark | ((1u << direction) - 1u));
    return first_vertex[start] + static_cast<std::uint32_t>(__builtin_popcount(before));
  }
};

/// Cuts the lattice, warps it, keeps the components asked for and numbers and places the vertices.
CutLattice cut_lattice(const ImplicitSurface& surface, const BccLattice& lattice,
                       const Component& component, const Run& run);

}  // namespace tissue
