#include "plan.h"

#include "tissue/base/parallel.h"
#include "tissue/refine/levels.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tissue {
namespace {

// The order of edges from which every diagonal comes: by squared length, to 1e-5 of the lattice
// spacing's square, then by the vertices' numbers.
class EdgeOrder {
 public:
  explicit EdgeOrder(const RefinableLattice& lattice) : edges_(lattice.edges.edges) {
    const double scale = 1e5 / (lattice.mesh.spacing * lattice.mesh.spacing);
    squared_lengths_.reserve(edges_.size());
    for (const Edge& edge : edges_) {
      const Vec3 along = lattice.mesh.vertices[edge[1]] - lattice.mesh.vertices[edge[0]];
      squared_lengths_.push_back(std::llround(along.squaredNorm() * scale));
    }
  }
  bool precedes(std::uint32_t a, std::uint32_t b) const {
    if (squared_lengths_[a] != squared_lengths_[b]) {
      return squared_lengths_[a] < squared_lengths_[b];
    }
    return edges_[a] < edges_[b];
  }

 private:
  const std::vector<Edge>& edges_;
  std::vector<std::int64_t> squared_lengths_;
};

void find_feature_levels(const RefinableLattice& lattice, RefinementPlan& plan) {
  plan.edge_levels.assign(lattice.edges.edges.size(), 0);
  plan.face_levels.assign(lattice.faces.face_tets.size(), 0);
  for (std::size_t t = 0; t < plan.levels.size(); ++t) {
    const std::uint8_t level = plan.levels[t];
    for (const std::uint32_t e : lattice.edges.tet_edges[t]) {
      plan.edge_levels[e] = std::max(plan.edge_levels[e], level);
    }
    for (const std::uint32_t f : lattice.faces.tet_faces[t]) {
      plan.face_levels[f] = std::max(plan.face_levels[f], level);
    }
  }
}

TemplateKey key_of(const RefinableLattice& lattice, const RefinementPlan& plan,
                   const EdgeOrder& order, std::size_t t) {
  const auto& tet_edges = lattice.edges.tet_edges[t];
  TemplateKey key;
  key.level = plan.levels[t];
  for (int e = 0; e < 6; ++e) {
    if (plan.edge_levels[tet_edges[e]] > key.level) key.finer_edges |= 1u << e;
  }
  if (key.finer_edges == 0) return key;
  for (int f = 0; f < 4; ++f) {
    if (plan.face_levels[lattice.faces.tet_faces[t][f]] > key.level) key.finer_faces |= 1u << f;
  }
  const unsigned deciding = key.deciding_corners();
  if (deciding == 0) return key;
  for (int f = 0; f < 4; ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      if ((deciding >> (3 * f + corner) & 1u) == 0) continue;
      const int z = kTetFaces[f][corner];
      const int lower = tet_edge(z, kTetFaces[f][corner == 0 ? 1 : 0]);
      const int upper = tet_edge(z, kTetFaces[f][corner == 2 ? 1 : 2]);
      if (order.precedes(tet_edges[lower], tet_edges[upper])) {
        key.first_edges |= 1u << (3 * f + corner);
      }
    }
  }
  return key;
}

std::array<Vec3, 4> corners_of(const LatticeMesh& mesh, std::size_t t) {
  const Tet& tet = mesh.tets[t];
  return {mesh.vertices[tet[0]], mesh.vertices[tet[1]], mesh.vertices[tet[2]],
          mesh.vertices[tet[3]]};
}

}  // namespace

RefinementPlan plan_refinement(const RefinableLattice& lattice, std::vector<std::uint8_t> levels,
                               TemplateLibrary& library, const Run& run) {
  const std::size_t count = lattice.mesh.tets.size();
  const EdgeOrder order(lattice);
  RefinementPlan plan;
  plan.levels = std::move(levels);
  const std::uint8_t finest =
      count == 0 ? std::uint8_t{0} : *std::max_element(plan.levels.begin(), plan.levels.end());

  // Promotion changes the keys of neighbours, so cut tets are fitted until no level changes; a tet
  // whose key has stayed the same keeps its fit.
  std::vector<TemplateKey> keys(count);
  std::vector<std::uint32_t> fitted_key(count, 0xffffffffu);
  std::vector<Fit> fits(count);
  for (bool settled = false; !settled;) {
    raise_levels(plan.levels, lattice.edges.tet_edges, lattice.edges.edges.size());
    find_feature_levels(lattice, plan);
    parallel_ranges(count, 1024, run, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) keys[t] = key_of(lattice, plan, order, t);
    });
    std::vector<std::pair<std::uint32_t, const Blueprint*>> to_fit;
    for (std::uint32_t t = 0; t < count; ++t) {
      if (lattice.mesh.whole[t] != 0 || keys[t].packed() == fitted_key[t]) continue;
      fitted_key[t] = keys[t].packed();
      to_fit.emplace_back(t, &library.blueprint(keys[t]));
    }
    parallel_ranges(to_fit.size(), 256, run, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto& [t, blueprint] = to_fit[i];
        fits[t] = fit(*blueprint, corners_of(lattice.mesh, t));
      }
    });
    settled = true;
    for (const auto& fitted : to_fit) {
      const std::uint32_t t = fitted.first;
      if (plan.levels[t] >= finest || shape_score(fits[t].range) >= 1.0) continue;
      ++plan.levels[t];
      ++plan.tets_promoted;
      settled = false;
    }
  }

  plan.templates.resize(count);
  for (std::size_t t = 0; t < count; ++t) {
    if (lattice.mesh.whole[t] != 0) {
      const TemplateLibrary::WholeTemplate& whole = library.whole(keys[t]);
      plan.templates[t] = whole.filled;
      plan.whole_dihedral.include(whole.range);
    } else {
      plan.templates[t] = &library.filled(keys[t], fits[t].choices);
      plan.cut_dihedral.include(fits[t].range);
    }
  }
  return plan;
}

}  // namespace tissue
