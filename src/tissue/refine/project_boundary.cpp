#include "tissue/refine/project_boundary.h"

#include "ring_guard.h"
#include "tissue/base/parallel.h"
#include "tissue/base/topology.h"
#include "tissue/field/surface_distance.h"
#include "tissue/field/surface_search.h"

#include <algorithm>

namespace tissue {
namespace {

// Below this fraction of a voxel a vertex has arrived.
constexpr double kArrived = 1e-3;
constexpr int kHalvings = 4;

class Projector {
 public:
  Projector(std::vector<Vec3f>& vertices, const std::vector<Tet>& tets,
            const std::vector<Triangle>& boundary, const std::vector<TetRange>& near, double unit,
            const Run& run)
      : vertices_(vertices),
        tets_(tets),
        unit_(unit),
        run_(run),
        moved_in_(vertices.size(), 0),
        on_boundary_(vertices.size(), 0) {
    std::vector<std::uint32_t> list = vertices_of(boundary, vertices.size());
    for (const std::uint32_t v : list) on_boundary_[v] = 1;
    rings_ = vertex_rings(std::move(list), tets, near, vertices.size(), run);
    targets_.resize(rings_.vertices.size());
    astray_.assign(rings_.vertices.size(), 1);
    for (const std::uint32_t v : rings_.vertices) before_.push_back(vertices[v]);
  }

  // Finds out where every vertex that has not arrived is to go.
  template <class Function>
  void aim(const Function& f, double voxel, double reach) {
    parallel_ranges(targets_.size(), 256, run_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (astray_[i] == 0) continue;
        const Vec3 place = vertices_[rings_.vertices[i]].template cast<double>();
        const SurfacePoint found = search_surface(f, place, voxel, reach);
        targets_[i] = found.place.template cast<float>();
        astray_[i] = !found.found || found.distance > kArrived * voxel;
      }
    });
  }

  void sweep() {
    ++sweep_;
    rings_.for_each_block(run_, [&](std::uint32_t begin, std::uint32_t end) {
      RingGuard guard(unit_);
      for (std::uint32_t which = begin; which < end; ++which) {
        if (astray_[which] == 0) continue;
        const Vec3f step = targets_[which] - vertices_[rings_.vertices[which]];
        // Where no surface was found the target is where the vertex was.
        if (step.isZero(0.0f) || !has_new_room(which)) continue;
        astray_[which] = !move(rings_, which, step, guard);
      }
    });
  }

  // Inner vertices next to boundary vertices that are held back take the mean displacement of their
  // neighbours, nearest first.
  void follow() {
    const std::vector<std::uint32_t> inner = inner_neighbours();
    if (inner.empty()) return;
    const VertexRings rings =
        vertex_rings(inner, tets_, {{0, tets_.size()}}, vertices_.size(), run_);
    std::vector<Vec3f> displacement(vertices_.size(), Vec3f::Zero());
    for (std::size_t i = 0; i < rings_.vertices.size(); ++i) {
      // What is held back pulls with the whole way that it has still to go.
      const Vec3f& end = astray_[i] != 0 ? targets_[i] : vertices_[rings_.vertices[i]];
      displacement[rings_.vertices[i]] = end - before_[i];
    }
    rings.for_each_block(run_, [&](std::uint32_t begin, std::uint32_t end) {
      RingGuard guard(unit_);
      for (std::uint32_t which = begin; which < end; ++which) {
        const std::uint32_t vertex = rings.vertices[which];
        Vec3f sum = Vec3f::Zero();
        int count = 0;
        for (std::uint32_t k = rings.begin[which]; k < rings.begin[which + 1]; ++k) {
          for (const std::uint32_t other : tets_[rings.tets[k]]) {
            if (other == vertex) continue;
            sum += displacement[other];
            ++count;
          }
        }
        const Vec3f place = vertices_[vertex];
        move(rings, which, sum / static_cast<float>(count), guard);
        displacement[vertex] = vertices_[vertex] - place;
      }
    });
  }

  bool all_arrived() const { return std::find(astray_.begin(), astray_.end(), 1) == astray_.end(); }
  std::vector<std::uint8_t> moved() const {
    std::vector<std::uint8_t> flags(moved_in_.size());
    for (std::size_t v = 0; v < flags.size(); ++v) flags[v] = moved_in_[v] != 0;
    return flags;
  }

 private:
  // Tets with a corner on the boundary may be worse than those within.
  inline static const AngleBounds kAtBoundary{10.0, 165.0}, kWithin{18.0, 162.0};

  // Unless it or a neighbour has moved since it was held back, a vertex will be held back again.
  bool has_new_room(std::uint32_t which) const {
    if (sweep_ == 1) return true;
    for (std::uint32_t k = rings_.begin[which]; k < rings_.begin[which + 1]; ++k) {
      for (const std::uint32_t v : tets_[rings_.tets[k]]) {
        if (moved_in_[v] + 1 >= sweep_) return true;
      }
    }
    return false;
  }

  bool is_at_boundary(const Tet& tet) const {
    return (on_boundary_[tet[0]] | on_boundary_[tet[1]] | on_boundary_[tet[2]] |
            on_boundary_[tet[3]]) != 0;
  }

  // Moves a vertex by as much of `step` as its ring allows. True if by all of it.
  bool move(const VertexRings& rings, std::uint32_t which, const Vec3f& step, RingGuard& guard) {
    const std::uint32_t vertex = rings.vertices[which];
    const std::uint32_t* ring = &rings.tets[rings.begin[which]];
    const std::size_t count = rings.begin[which + 1] - rings.begin[which];
    guard.gather(vertex, ring, count, tets_, vertices_);
    // All tets around a boundary vertex are at the boundary.
    const bool is_within = on_boundary_[vertex] == 0;
    for (std::size_t i = 0; i < count; ++i) {
      guard.bound(i, is_within && !is_at_boundary(tets_[ring[i]]) ? kWithin : kAtBoundary);
    }
    const Vec3f start = vertices_[vertex];
    float part = 1.0f;
    for (int halvings = 0; halvings < kHalvings; ++halvings, part *= 0.5f) {
      const Vec3f there = start + part * step;
      if (!guard.allows(there - start)) continue;
      vertices_[vertex] = there;
      moved_in_[vertex] = sweep_;
      return halvings == 0;
    }
    return false;
  }

  std::vector<std::uint32_t> inner_neighbours() const {
    std::vector<std::uint8_t> wanted(vertices_.size(), 0);
    for (std::size_t i = 0; i < rings_.vertices.size(); ++i) {
      if (astray_[i] == 0) continue;
      for (std::uint32_t k = rings_.begin[i]; k < rings_.begin[i + 1]; ++k) {
        for (const std::uint32_t v : tets_[rings_.tets[k]]) wanted[v] = on_boundary_[v] == 0;
      }
    }
    std::vector<std::uint32_t> result;
    for (std::uint32_t v = 0; v < wanted.size(); ++v) {
      if (wanted[v] != 0) result.push_back(v);
    }
    return result;
  }

  std::vector<Vec3f>& vertices_;
  const std::vector<Tet>& tets_;
  double unit_;
  const Run& run_;
  // The sweep in which each vertex moved last; 0: never.
  std::vector<std::uint8_t> moved_in_;
  std::uint8_t sweep_ = 0;
  std::vector<std::uint8_t> on_boundary_;
  VertexRings rings_;
  // By index into the rings' vertices: whether the vertex has not arrived, where it is to go, and
  // where it started.
  std::vector<std::uint8_t> astray_;
  std::vector<Vec3f> targets_;
  std::vector<Vec3f> before_;
};

}  // namespace

std::vector<std::uint8_t> project_boundary(const ImplicitSurface& surface,
                                           std::vector<Vec3f>& vertices,
                                           const std::vector<Tet>& tets,
                                           const std::vector<Triangle>& boundary,
                                           const std::vector<TetRange>& near, double reach,
                                           const ProjectionOptions& options, const Run& run) {
  Projector projector(vertices, tets, boundary, near, reach, run);
  const double voxel = surface.field->grid.spacing.minCoeff();
  with_implicit_function(surface, [&](const auto& f) {
    projector.aim(f, voxel, reach);
    for (int i = 0; i < options.sweeps && !projector.all_arrived(); ++i) projector.sweep();
    if (options.sweeps_after_following == 0 || projector.all_arrived()) return;
    for (int i = 0; i < options.sweeps_after_following && !projector.all_arrived(); ++i) {
      projector.follow();
      projector.aim(f, voxel, reach);
      projector.sweep();
    }
  });
  return projector.moved();
}

std::vector<TetRange> tets_near_boundary(const std::vector<Tet>& lattice_tets,
                                         const std::vector<std::size_t>& first_tet,
                                         const std::vector<Triangle>& boundary,
                                         std::uint32_t lattice_vertices) {
  std::vector<std::uint8_t> on_boundary(lattice_vertices, 0);
  for (const Triangle& triangle : boundary) {
    for (const std::uint32_t v : triangle) {
      if (v < lattice_vertices) on_boundary[v] = 1;
    }
  }
  std::vector<TetRange> ranges;
  for (std::size_t t = 0; t < lattice_tets.size(); ++t) {
    const Tet& tet = lattice_tets[t];
    if ((on_boundary[tet[0]] | on_boundary[tet[1]] | on_boundary[tet[2]] | on_boundary[tet[3]]) ==
        0) {
      continue;
    }
    if (ranges.empty() || ranges.back().end != first_tet[t]) {
      ranges.push_back({first_tet[t], first_tet[t]});
    }
    ranges.back().end = first_tet[t + 1];
  }
  return ranges;
}

}  // namespace tissue
