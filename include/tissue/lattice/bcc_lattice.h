#pragma once

#include "tissue/base/types.h"

#include <cstddef>

namespace tissue {

/// The body-centred cubic lattice: the corners ("even" points) and centres ("odd" points) of cubic
/// cells. Doubled coordinates (X, Y, Z) are all even or all odd; their place is
/// origin + (spacing/2)(X, Y, Z). Long edges, along an axis, have length `spacing`; short edges,
/// along a body diagonal, spacing·√3/2.
///
/// Every edge is named by the one of its ends from which it runs in a canonical direction:
/// edge = 7·point + direction. Points and edges are numbered by arithmetic; nothing is searched.
struct BccLattice {
  static constexpr int kDirections = 7;
  /// Canonical directions in doubled coordinates; the first three are long.
  static constexpr std::array<std::array<int, 3>, kDirections> kStep = {{{{2, 0, 0}},
                                                                         {{0, 2, 0}},
                                                                         {{0, 0, 2}},
                                                                         {{1, 1, 1}},
                                                                         {{1, -1, 1}},
                                                                         {{1, 1, -1}},
                                                                         {{1, -1, -1}}}};

  Vec3 origin = Vec3::Zero();
  /// Length of a long edge [m].
  double spacing = 1.0;
  /// Points of either parity along each axis.
  std::array<std::int64_t, 3> size = {0, 0, 0};

  std::int64_t point_count() const { return 2 * size[0] * size[1] * size[2]; }
  std::int64_t point(std::int64_t x, std::int64_t y, std::int64_t z, int parity) const {
    return 2 * (x + size[0] * (y + size[1] * z)) + parity;
  }
  /// Difference of the numbers of two points that lie `step` apart (doubled coordinates), for a
  /// start of this parity.
  std::int64_t offset(int parity, const std::array<int, 3>& step) const {
    const int end_parity = (parity + step[0]) & 1;
    std::array<std::int64_t, 3> cells{};
    for (int axis = 0; axis < 3; ++axis) cells[axis] = (parity + step[axis] - end_parity) / 2;
    return 2 * (cells[0] + size[0] * (cells[1] + size[1] * cells[2])) + end_parity - parity;
  }
  Vec3 place(std::int64_t point) const {
    const std::int64_t cell = point / 2;
    return place(cell % size[0], cell / size[0] % size[1], cell / size[0] / size[1],
                 static_cast<int>(point % 2));
  }
  Vec3 place(std::int64_t x, std::int64_t y, std::int64_t z, int parity) const {
    const double half = 0.5 * parity;
    return origin + spacing * Vec3(static_cast<double>(x) + half, static_cast<double>(y) + half,
                                   static_cast<double>(z) + half);
  }
  static double edge_length(int direction, double spacing) {
    return direction < 3 ? spacing : spacing * 0.86602540378443864676;
  }
};

/// The twelve tets around one odd point, as steps from it in doubled coordinates. Corners are in
/// the order in which Bey's refinement keeps their shape: edges (0, 2) and (1, 3) are long. Volumes
/// are positive.
struct BccTet {
  std::array<std::array<int, 3>, 4> corners;
  /// The canonical start of each edge (a corner of this tet) and its direction.
  struct NamedEdge {
    int start;
    int direction;
  };
  std::array<NamedEdge, 6> edges;
};
const std::array<BccTet, 12>& bcc_tets();

}  // namespace tissue
