#include "tissue/refine/refine.h"

#include "filler.h"
#include "plan.h"

#include <utility>

namespace tissue {
namespace {

// The twelve orders of corners that keep a tet's volume positive.
constexpr std::array<std::array<int, 4>, 12> kPositiveOrders = {{{{0, 1, 2, 3}},
                                                                 {{0, 2, 3, 1}},
                                                                 {{0, 3, 1, 2}},
                                                                 {{1, 0, 3, 2}},
                                                                 {{1, 2, 0, 3}},
                                                                 {{1, 3, 2, 0}},
                                                                 {{2, 0, 1, 3}},
                                                                 {{2, 1, 3, 0}},
                                                                 {{2, 3, 0, 1}},
                                                                 {{3, 0, 2, 1}},
                                                                 {{3, 1, 0, 2}},
                                                                 {{3, 2, 1, 0}}}};

// How good the inner children of Bey's refinement are; the outer ones have the parent's shape.
double inner_children_score(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3) {
  const Vec3 x01 = x0 + x1, x02 = x0 + x2, x03 = x0 + x3, x12 = x1 + x2, x13 = x1 + x3;
  DihedralRange range = dihedral_range(x01, x02, x03, x13);
  range.include(dihedral_range(x01, x02, x12, x13));
  return shape_score(range);
}

Tet best_order(const std::vector<Vec3>& vertices, const Tet& tet) {
  Tet best = tet;
  double best_score = -1.0;
  for (const auto& order : kPositiveOrders) {
    const Tet ordered = {tet[order[0]], tet[order[1]], tet[order[2]], tet[order[3]]};
    const double score = inner_children_score(vertices[ordered[0]], vertices[ordered[1]],
                                              vertices[ordered[2]], vertices[ordered[3]]);
    if (score > best_score) {
      best = ordered;
      best_score = score;
    }
  }
  return best;
}

}  // namespace

RefinableLattice refinable(LatticeMesh mesh) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.whole[t] == 0) mesh.tets[t] = best_order(mesh.vertices, mesh.tets[t]);
  }
  RefinableLattice lattice;
  lattice.faces = face_topology(mesh.tets, mesh.vertices.size());
  lattice.edges = edge_topology(mesh.tets, mesh.vertices.size());
  lattice.mesh = std::move(mesh);
  return lattice;
}

RefinedMesh refine(const RefinableLattice& lattice, std::vector<std::uint8_t> levels,
                   std::uint64_t max_tets, int threads) {
  TemplateLibrary library;
  RefinementPlan plan = plan_refinement(lattice, std::move(levels), library);
  RefinedMesh mesh = fill_mesh(lattice, plan, number_blocks(lattice, plan, max_tets), threads);
  mesh.lattice_levels = std::move(plan.levels);
  mesh.dihedral = plan.dihedral;
  mesh.tets_promoted = plan.tets_promoted;
  return mesh;
}

}  // namespace tissue
