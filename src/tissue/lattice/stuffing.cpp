#include "tissue/lattice/stuffing.h"

#include "cut_lattice.h"
#include "repair.h"
#include "stencils.h"
#include "tissue/base/error.h"
#include "tissue/base/parallel.h"
#include "tissue/base/tet_mesh.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace tissue {
namespace {

BccLattice lattice_around(const Grid& grid, const StuffingOptions& options) {
  if (!(options.spacing > 0.0 && std::isfinite(options.spacing))) {
    throw InputError(ErrorCode::kParam,
                     "spacing: " + to_text(options.spacing) + " m is not positive");
  }
  // Two layers of points beyond the voxels, so that no edge of an inside point leaves the lattice
  // wherever an offset within half a cell puts it.
  constexpr double kMargin = 2.5;
  BccLattice lattice;
  lattice.spacing = options.spacing;
  double points = 2.0;
  std::array<double, 3> size{};
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = grid.size[axis] * grid.spacing[axis];
    size[axis] = std::ceil(extent / options.spacing) + 2.0 * kMargin + 1.0;
    const double slack = (size[axis] - 1.0) * options.spacing - extent;
    lattice.origin[axis] = -0.5 * grid.spacing[axis] - 0.5 * slack +
                           std::remainder(options.offset[axis], 1.0) * options.spacing;
    points *= size[axis];
  }
  const double limit = std::min(options.max_points, 4e9);  // Points are numbered in 32 bits.
  if (!(points <= limit)) {
    throw InputError(ErrorCode::kTooManyTets, "spacing: " + to_text(options.spacing) +
                                                  " m needs a lattice of " + to_text(points) +
                                                  " points, the limit is " + to_text(limit));
  }
  for (int axis = 0; axis < 3; ++axis) lattice.size[axis] = static_cast<std::int64_t>(size[axis]);
  return lattice;
}

// Fills every lattice tet with its stencil, layer by layer.
class Filler {
 public:
  Filler(const CutLattice& cut, const Run& run) : cut_(cut), run_(run) {
    for (std::size_t k = 0; k < bcc_tets().size(); ++k) {
      for (int i = 0; i < 4; ++i) {
        corner_offsets_[k][i] = cut.lattice.offset(1, bcc_tets()[k].corners[i]);
        if (std::find(around_.begin(), around_.end(), corner_offsets_[k][i]) == around_.end()) {
          around_.push_back(corner_offsets_[k][i]);
        }
      }
    }
  }

  // The number of tets in every layer of cells, and a zero behind.
  std::vector<std::size_t> count() const {
    std::vector<std::size_t> counts(cut_.lattice.size[2] + 1, 0);
    for_each_layer([&](std::int64_t layer) {
      for_each_cell(layer, [&](std::int64_t odd, int inside) {
        counts[layer] +=
            inside == static_cast<int>(around_.size()) ? bcc_tets().size() : count_cut(odd);
      });
    });
    return counts;
  }

  void fill(LatticeMesh& mesh) const {
    const std::vector<std::size_t> counts = count();
    std::vector<std::size_t> first(counts.size() + 1, 0);
    std::partial_sum(counts.begin(), counts.end(), first.begin() + 1);
    mesh.tets.resize(first.back());
    mesh.whole.resize(first.back());
    for_each_layer([&](std::int64_t layer) {
      std::size_t next = first[layer];
      for_each_cell(layer, [&](std::int64_t odd, int inside) {
        for (std::size_t k = 0; k < bcc_tets().size(); ++k) {
          if (inside == static_cast<int>(around_.size())) {
            for (int i = 0; i < 4; ++i) {
              mesh.tets[next][i] = cut_.vertex_at(odd + corner_offsets_[k][i]);
            }
            mesh.whole[next++] = 1;
          } else {
            next = fill_cut(odd, k, mesh, next);
          }
        }
      });
    });
  }

 private:
  template <class Body>
  void for_each_layer(const Body& body) const {
    parallel_ranges(static_cast<std::size_t>(cut_.lattice.size[2] - 3), 1, run_,
                    [&](std::size_t begin, std::size_t end) {
                      for (std::size_t i = begin; i < end; ++i) {
                        body(static_cast<std::int64_t>(i) + 1);
                      }
                    });
  }

  // Calls body(odd point, number of inside points among those that its tets use) where there are
  // any.
  template <class Body>
  void for_each_cell(std::int64_t z, const Body& body) const {
    const BccLattice& lattice = cut_.lattice;
    for (std::int64_t y = 1; y < lattice.size[1] - 2; ++y) {
      for (std::int64_t x = 1; x < lattice.size[0] - 2; ++x) {
        const std::int64_t odd = lattice.point(x, y, z, 1);
        int inside = 0;
        for (const std::int64_t offset : around_) inside += cut_.states[odd + offset] == kInside;
        if (inside > 0) body(odd, inside);
      }
    }
  }

  const Stencil& stencil_at(std::int64_t odd, std::size_t k) const {
    std::array<int, 4> signs{};
    for (int i = 0; i < 4; ++i) {
      const PointState state = cut_.states[odd + corner_offsets_[k][i]];
      signs[i] = state == kWarped ? 0 : state;
    }
    return stencil_for(static_cast<int>(k), signs);
  }

  std::size_t count_cut(std::int64_t odd) const {
    std::size_t count = 0;
    for (std::size_t k = 0; k < bcc_tets().size(); ++k) {
      count += static_cast<std::size_t>(stencil_at(odd, k).count);
    }
    return count;
  }

  std::size_t fill_cut(std::int64_t odd, std::size_t k, LatticeMesh& mesh, std::size_t next) const {
    const Stencil& stencil = stencil_at(odd, k);
    for (int t = 0; t < stencil.count; ++t) {
      Tet& tet = mesh.tets[next];
      bool whole = true;
      for (int i = 0; i < 4; ++i) {
        const StencilPoint point = stencil.tets[t][i];
        if (point < 4) {
          const std::int64_t lattice_point = odd + corner_offsets_[k][point];
          tet[i] = cut_.vertex_at(lattice_point);
          whole = whole && cut_.states[lattice_point] != kWarped;
        } else {
          const BccTet::NamedEdge edge = bcc_tets()[k].edges[point - 4];
          tet[i] = cut_.vertex_at_cut(odd + corner_offsets_[k][edge.start], edge.direction);
          whole = false;
        }
      }
      if (!whole && determinant(cut_.vertices, tet) < 0.0) {
        std::swap(tet[0], tet[2]);
      }
      mesh.whole[next++] = whole ? 1 : 0;
    }
    return next;
  }

  const CutLattice& cut_;
  const Run& run_;
  std::array<std::array<std::int64_t, 4>, 12> corner_offsets_{};
  std::vector<std::int64_t> around_;
};

// A spacing at which even a single voxel holds points of the lattice that no warp takes away.
double spacing_that_would_do(const Grid& grid, double spacing) {
  return std::min(0.5 * spacing, 0.5 * grid.spacing.minCoeff());
}

}  // namespace

LatticeMesh stuff(const ImplicitSurface& surface, const StuffingOptions& options, const Run& run) {
  const BccLattice lattice = lattice_around(surface.field->grid, options);
  LatticeMesh mesh;
  std::vector<std::uint8_t> on_surface;
  {
    CutLattice cut = cut_lattice(surface, lattice, options.component, run);
    Filler(cut, run).fill(mesh);
    mesh.spacing = lattice.spacing;
    mesh.border_touched = cut.border_touched;
    mesh.components_dropped = cut.components_dropped;
    mesh.vertices = std::move(cut.vertices);
    on_surface = std::move(cut.on_surface);
  }
  if (!mesh.tets.empty()) {
    repair(mesh, std::move(on_surface), options.component.choice == Component::Choice::kAll, run);
  }
  if (mesh.tets.empty()) {
    throw InputError(
        ErrorCode::kTooSmall,
        "spacing: at " + to_text(options.spacing) + " m the organ slips through the lattice; " +
            to_text(spacing_that_would_do(surface.field->grid, options.spacing)) + " m would do");
  }
  return mesh;
}

std::uint64_t count_stuffed(const ImplicitSurface& surface, const StuffingOptions& options,
                            const Run& run) {
  const BccLattice lattice = lattice_around(surface.field->grid, options);
  const CutLattice cut = cut_lattice(surface, lattice, options.component, run);
  const std::vector<std::size_t> counts = Filler(cut, run).count();
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

}  // namespace tissue
