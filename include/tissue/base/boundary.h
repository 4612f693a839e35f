#pragma once

#include "tissue/base/types.h"

#include <cstddef>
#include <map>
#include <vector>

namespace tissue {

/// A face that belongs to one tet only; its corners outward.
struct BoundaryTriangle {
  std::uint32_t tet;
  Triangle corners;
};

/// The boundary of the tets whose `kept` is set, or of all if it is empty. `on_surface` is set for
/// every vertex of a boundary face, so that only tets with three such vertices are looked at.
std::vector<BoundaryTriangle> boundary_triangles(const std::vector<Tet>& tets,
                                                 const std::vector<std::uint8_t>& kept,
                                                 const std::vector<std::uint8_t>& on_surface);

/// Where a boundary is not a manifold.
struct Defects {
  /// Vertices with more than one fan of boundary triangles or with an edge of more than two.
  std::vector<std::uint32_t> vertices;
  /// For each such vertex, the tets at its smaller fans.
  std::map<std::uint32_t, std::vector<std::uint32_t>> tets_of_smaller_fans;
  /// Edges in more than two boundary triangles.
  std::vector<Edge> edges;
};
Defects find_defects(const std::vector<BoundaryTriangle>& boundary, std::size_t vertex_count);

}  // namespace tissue
