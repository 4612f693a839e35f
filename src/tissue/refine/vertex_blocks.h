#pragma once

#include "plan.h"

#include <vector>

namespace tissue {

/// Where the points inside every edge, face and tet of the lattice begin among the vertices, and
/// the tets and boundary triangles of every lattice tet among all of them.
struct VertexBlocks {
  std::vector<std::uint32_t> edge_begin, face_begin, tet_begin;
  /// One more than there are lattice tets: the last is the total.
  std::vector<std::size_t> first_tet, first_triangle;
  std::uint32_t vertex_count = 0;
};

/// Throws InputError E_TOO_MANY_TETS if there would be more than `max_tets` tets, or more vertices
/// than 32 bits can number.
VertexBlocks number_blocks(const RefinableLattice& lattice, const RefinementPlan& plan,
                           std::uint64_t max_tets);

}  // namespace tissue
