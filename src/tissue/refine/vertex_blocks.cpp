#include "vertex_blocks.h"

#include "numbering.h"
#include "tissue/base/error.h"

#include <limits>

namespace tissue {

VertexBlocks number_blocks(const RefinableLattice& lattice, const RefinementPlan& plan,
                           std::uint64_t max_tets) {
  VertexBlocks blocks;
  std::uint64_t next = lattice.mesh.vertices.size();
  const auto take = [&next](std::uint64_t count) {
    const std::uint64_t begin = next;
    next += count;
    return static_cast<std::uint32_t>(begin);
  };
  for (const std::uint8_t level : plan.edge_levels) {
    blocks.edge_begin.push_back(take(edge_points(1u << level)));
  }
  for (const std::uint8_t level : plan.face_levels) {
    blocks.face_begin.push_back(take(face_points(1u << level)));
  }
  std::size_t tets = 0, triangles = 0;
  for (std::size_t t = 0; t < plan.templates.size(); ++t) {
    const Template& filled = *plan.templates[t];
    blocks.tet_begin.push_back(take(interior_points_count(filled.tet_parts)));
    blocks.first_tet.push_back(tets);
    blocks.first_triangle.push_back(triangles);
    tets += filled.tets.size();
    for (int f = 0; f < 4; ++f) {
      if (lattice.faces.face_tets[lattice.faces.tet_faces[t][f]][1] == kNoTet) {
        triangles += filled.face_triangles[f].size();
      }
    }
  }
  blocks.first_tet.push_back(tets);
  blocks.first_triangle.push_back(triangles);
  if (tets > max_tets || next > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError(ErrorCode::kTooManyTets, "refinement: " + std::to_string(tets) +
                                                  " tets would come out, the limit is " +
                                                  std::to_string(max_tets));
  }
  blocks.vertex_count = static_cast<std::uint32_t>(next);
  return blocks;
}

}  // namespace tissue
