#include "tissue/refine/refine.h"

#include "filler.h"
#include "plan.h"
#include "tissue/base/parallel.h"

#include <utility>

namespace tissue {
namespace {

// Of the twelve orders of corners that keep a tet's volume positive, one for each diagonal of the
// inner octahedron: the four children along a diagonal are two congruent pairs, so that the other
// orders are as good.
constexpr std::array<std::array<int, 4>, 3> kDiagonals = {
    {{{0, 1, 2, 3}}, {{0, 2, 3, 1}}, {{0, 3, 1, 2}}}};

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
  for (const auto& order : kDiagonals) {
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

RefinableLattice refinable(LatticeMesh mesh, const Run& run) {
  parallel_ranges(mesh.tets.size(), 1024, run, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      if (mesh.whole[t] == 0) mesh.tets[t] = best_order(mesh.vertices, mesh.tets[t]);
    }
  });
  RefinableLattice lattice;
  run.go_on();
  lattice.faces = face_topology(mesh.tets, mesh.vertices.size());
  run.go_on();
  lattice.edges = edge_topology(mesh.tets, mesh.vertices.size());
  lattice.mesh = std::move(mesh);
  return lattice;
}

RefinedMesh refine(const RefinableLattice& lattice, std::vector<std::uint8_t> levels,
                   std::uint64_t max_tets, const Run& run) {
  TemplateLibrary library;
  RefinementPlan plan = plan_refinement(lattice, std::move(levels), library, run);
  RefinedMesh mesh = fill_mesh(lattice, plan, number_blocks(lattice, plan, max_tets), run);
  mesh.lattice_levels = std::move(plan.levels);
  mesh.dihedral = plan.whole_dihedral;
  mesh.dihedral.include(plan.cut_dihedral);
  return mesh;
}

}  // namespace tissue
