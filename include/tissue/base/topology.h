#pragma once

#include "tissue/base/types.h"

#include <vector>

namespace tissue {

constexpr std::uint32_t kNoTet = 0xffffffffu;

/// Which tets meet at which face.
struct FaceTopology {
  /// Faces of each tet, in the order of kTetFaces.
  std::vector<std::array<std::uint32_t, 4>> tet_faces;
  /// The one or two tets at each face; the second is kNoTet on the boundary.
  std::vector<std::array<std::uint32_t, 2>> face_tets;
};

/// Which edges belong to which tet.
struct EdgeTopology {
  /// Edges of each tet, in the order of kTetEdges.
  std::vector<std::array<std::uint32_t, 6>> tet_edges;
  /// Ends of each edge, the lower index first.
  std::vector<Edge> edges;
};

/// Faces are numbered in the order in which the tets name them.
/// Throws InputError E_CONFORMITY where a face belongs to more than two tets.
FaceTopology face_topology(const std::vector<Tet>& tets, std::size_t vertex_count);

/// Edges are numbered in the order in which the tets name them.
EdgeTopology edge_topology(const std::vector<Tet>& tets, std::size_t vertex_count);

/// The vertices that triangles use, ascending. `vertex_count` is that of the mesh.
std::vector<std::uint32_t> vertices_of(const std::vector<Triangle>& triangles,
                                       std::size_t vertex_count);

}  // namespace tissue
