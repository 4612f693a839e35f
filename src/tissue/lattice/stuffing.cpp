#include "tissue/lattice/stuffing.h"

#include "repair.h"
#include "stencils.h"
#include "tissue/base/error.h"
#include "tissue/base/tet_mesh.h"
#include "tissue/lattice/bcc_lattice.h"

#include <cmath>
#include <utility>

namespace tissue {
namespace {

// A cut point that is nearer to an end of its edge than this fraction of the edge's length pulls
// the end onto the surface. The pair keeps dihedral angles within 10.76° and 164.70° (Labelle and
// Shewchuk 2007, the bound of their abstract).
constexpr double kAlphaLong = 0.285;
constexpr double kAlphaShort = 0.399;

constexpr std::uint32_t kNone = 0xffffffffu;

double alpha(int direction) { return direction < 3 ? kAlphaLong : kAlphaShort; }

// The lattice with what the surface does to it.
struct CutLattice {
  BccLattice lattice;
  std::array<std::array<std::int64_t, BccLattice::kDirections>, 2> offsets;
  std::vector<std::int8_t> signs;
  // Cut points lie on the edges of a point in the order of their directions.
  std::vector<std::uint8_t> cut_directions;
  std::vector<std::uint32_t> first_cut;
  struct Cut {
    std::int64_t point;
    int direction;
    // Fraction of the edge from its canonical start.
    double t;
  };
  std::vector<Cut> cuts;
  // For a warped point, the cut that it moved to.
  std::vector<std::uint32_t> warped_to;
  bool border_touched = false;

  std::int64_t end_of(const Cut& cut) const {
    return cut.point + offsets[cut.point & 1][cut.direction];
  }
  std::uint32_t cut_on(std::int64_t start, int direction) const {
    const unsigned before = cut_directions[start] & ((1u << direction) - 1u);
    return first_cut[start] + static_cast<std::uint32_t>(__builtin_popcount(before));
  }
  Vec3 place_of(const Cut& cut) const {
    const Vec3 a = lattice.place(cut.point), b = lattice.place(end_of(cut));
    return a + cut.t * (b - a);
  }
};

BccLattice lattice_around(const Grid& grid, const StuffingOptions& options) {
  // Two layers of points beyond the voxels, so that no edge of an inside point leaves the lattice.
  constexpr double kMargin = 2.0;
  BccLattice lattice;
  lattice.spacing = options.spacing;
  double points = 2.0;
  std::array<double, 3> size{};
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = grid.size[axis] * grid.spacing[axis];
    size[axis] = std::ceil(extent / options.spacing) + 2.0 * kMargin + 1.0;
    const double slack = (size[axis] - 1.0) * options.spacing - extent;
    lattice.origin[axis] = -0.5 * grid.spacing[axis] - 0.5 * slack;
    points *= size[axis];
  }
  if (!(points <= options.max_points)) {
    throw InputError(ErrorCode::kTooManyTets,
                     "spacing: " + to_text(options.spacing) + " m needs a lattice of " +
                         to_text(points) + " points, the limit is " + to_text(options.max_points));
  }
  for (int axis = 0; axis < 3; ++axis) lattice.size[axis] = static_cast<std::int64_t>(size[axis]);
  return lattice;
}

template <class Function>
CutLattice cut_lattice(const Function& f, const BccLattice& lattice) {
  CutLattice result;
  result.lattice = lattice;
  for (int parity = 0; parity < 2; ++parity) {
    for (int d = 0; d < BccLattice::kDirections; ++d) {
      result.offsets[parity][d] = lattice.offset(parity, BccLattice::kStep[d]);
    }
  }
  const std::int64_t count = lattice.point_count();
  result.signs.assign(count, 1);
  result.cut_directions.assign(count, 0);
  result.first_cut.assign(count, 0);
  std::vector<float> values(count, 1.0f);

  const auto for_each_point = [&](std::int64_t margin, const auto& body) {
    const auto& size = lattice.size;
    for (std::int64_t z = margin; z < size[2] - margin; ++z) {
      for (std::int64_t y = margin; y < size[1] - margin; ++y) {
        for (std::int64_t x = margin; x < size[0] - margin; ++x) {
          body(lattice.point(x, y, z, 0));
          body(lattice.point(x, y, z, 1));
        }
      }
    }
  };
  for_each_point(1, [&](std::int64_t point) {
    const Vec3 place = lattice.place(point);
    const double value = f(place);
    values[point] = static_cast<float>(value);
    result.signs[point] = static_cast<std::int8_t>((value > 0.0) - (value < 0.0));
    if (value > 0.0 && !result.border_touched && f.beyond_border(place) > 0.0) {
      result.border_touched = f.field(place) < 0.0;
    }
  });
  for_each_point(1, [&](std::int64_t point) {
    result.first_cut[point] = static_cast<std::uint32_t>(result.cuts.size());
    for (int d = 0; d < BccLattice::kDirections; ++d) {
      const std::int64_t end = point + result.offsets[point & 1][d];
      if (result.signs[point] * result.signs[end] >= 0) continue;
      const double t =
          bracketed_root(f, lattice.place(point), lattice.place(end), values[point], values[end]);
      result.cut_directions[point] =
          static_cast<std::uint8_t>(result.cut_directions[point] | (1u << d));
      result.cuts.push_back({point, d, t});
    }
  });
  return result;
}

// Moves every violated point to the nearest cut that violates it (on a tie, the one on the lowest
// edge). All decisions rest on the signs before any warp, so that no order matters.
void warp(CutLattice& cut_lattice) {
  std::vector<std::uint32_t>& warped_to = cut_lattice.warped_to;
  warped_to.assign(cut_lattice.signs.size(), kNone);
  std::vector<std::int64_t> moved;
  const auto distance_to = [&](std::uint32_t cut_index, std::int64_t point) {
    const CutLattice::Cut& cut = cut_lattice.cuts[cut_index];
    const double fraction = cut.point == point ? cut.t : 1.0 - cut.t;
    return fraction * BccLattice::edge_length(cut.direction, 1.0);
  };
  for (std::uint32_t c = 0; c < cut_lattice.cuts.size(); ++c) {
    const CutLattice::Cut& cut = cut_lattice.cuts[c];
    const double limit = alpha(cut.direction) * BccLattice::edge_length(cut.direction, 1.0);
    for (const std::int64_t point : {cut.point, cut_lattice.end_of(cut)}) {
      const double distance = distance_to(c, point);
      if (!(distance < limit)) continue;
      if (warped_to[point] == kNone) {
        moved.push_back(point);
      } else if (!(distance < distance_to(warped_to[point], point))) {
        continue;
      }
      warped_to[point] = c;
    }
  }
  for (const std::int64_t point : moved) cut_lattice.signs[point] = 0;
}

// Fills every lattice tet with its stencil; vertices are numbered as they are first needed.
class Filler {
 public:
  explicit Filler(const CutLattice& cut_lattice)
      : cut_lattice_(cut_lattice),
        point_vertex_(cut_lattice.signs.size(), kNone),
        cut_vertex_(cut_lattice.cuts.size(), kNone) {
    for (std::size_t k = 0; k < bcc_tets().size(); ++k) {
      for (int i = 0; i < 4; ++i) {
        corner_offsets_[k][i] = cut_lattice.lattice.offset(1, bcc_tets()[k].corners[i]);
      }
    }
  }

  LatticeMesh fill() {
    const BccLattice& lattice = cut_lattice_.lattice;
    mesh_.spacing = lattice.spacing;
    for (std::int64_t z = 1; z < lattice.size[2] - 2; ++z) {
      for (std::int64_t y = 1; y < lattice.size[1] - 2; ++y) {
        for (std::int64_t x = 1; x < lattice.size[0] - 2; ++x) {
          const std::int64_t odd = lattice.point(x, y, z, 1);
          for (std::size_t k = 0; k < bcc_tets().size(); ++k) fill_tet_at(odd, k);
        }
      }
    }
    return std::move(mesh_);
  }

 private:
  void fill_tet_at(std::int64_t odd, std::size_t k) {
    std::array<std::int64_t, 4> points{};
    std::array<int, 4> signs{};
    bool any_inside = false;
    for (int i = 0; i < 4; ++i) {
      points[i] = odd + corner_offsets_[k][i];
      signs[i] = cut_lattice_.signs[points[i]];
      any_inside = any_inside || signs[i] < 0;
    }
    if (!any_inside) return;
    const Stencil stencil = fill_tet(signs, bcc_tets()[k].corners);
    for (int t = 0; t < stencil.count; ++t) {
      Tet tet{};
      bool whole = true;
      for (int i = 0; i < 4; ++i) {
        const StencilPoint point = stencil.tets[t][i];
        if (point < 4) {
          tet[i] = vertex_at(points[point]);
          whole = whole && cut_lattice_.warped_to[points[point]] == kNone;
        } else {
          const BccTet::NamedEdge edge = bcc_tets()[k].edges[point - 4];
          tet[i] = vertex_at_cut(cut_lattice_.cut_on(points[edge.start], edge.direction));
          whole = false;
        }
      }
      if (!whole && determinant(mesh_.vertices[tet[0]], mesh_.vertices[tet[1]],
                                mesh_.vertices[tet[2]], mesh_.vertices[tet[3]]) < 0.0) {
        std::swap(tet[0], tet[2]);
      }
      mesh_.tets.push_back(tet);
      mesh_.whole.push_back(whole ? 1 : 0);
    }
  }

  std::uint32_t vertex_at(std::int64_t point) {
    std::uint32_t& vertex = point_vertex_[point];
    if (vertex == kNone) {
      const std::uint32_t cut = cut_lattice_.warped_to[point];
      vertex = add_vertex(cut == kNone ? cut_lattice_.lattice.place(point)
                                       : cut_lattice_.place_of(cut_lattice_.cuts[cut]));
    }
    return vertex;
  }
  std::uint32_t vertex_at_cut(std::uint32_t cut) {
    std::uint32_t& vertex = cut_vertex_[cut];
    if (vertex == kNone) vertex = add_vertex(cut_lattice_.place_of(cut_lattice_.cuts[cut]));
    return vertex;
  }
  std::uint32_t add_vertex(const Vec3& place) {
    mesh_.vertices.push_back(place);
    return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }

  const CutLattice& cut_lattice_;
  std::array<std::array<std::int64_t, 4>, 12> corner_offsets_{};
  std::vector<std::uint32_t> point_vertex_, cut_vertex_;
  LatticeMesh mesh_;
};

// A spacing at which even a single voxel holds points of the lattice that no warp takes away.
double spacing_that_would_do(const Grid& grid, double spacing) {
  return std::min(0.5 * spacing, 0.5 * grid.spacing.minCoeff());
}

}  // namespace

LatticeMesh stuff(const ImplicitSurface& surface, const StuffingOptions& options) {
  if (!(options.spacing > 0.0 && std::isfinite(options.spacing))) {
    throw InputError(ErrorCode::kParam,
                     "spacing: " + to_text(options.spacing) + " m is not positive");
  }
  const BccLattice lattice = lattice_around(surface.field->grid, options);
  CutLattice cut =
      with_implicit_function(surface, [&](const auto& f) { return cut_lattice(f, lattice); });
  warp(cut);
  LatticeMesh mesh = Filler(cut).fill();
  mesh.border_touched = cut.border_touched;
  repair(mesh, options.all_components);
  if (mesh.tets.empty()) {
    throw InputError(
        ErrorCode::kTooSmall,
        "spacing: at " + to_text(options.spacing) + " m the organ slips through the lattice; " +
            to_text(spacing_that_would_do(surface.field->grid, options.spacing)) + " m would do");
  }
  return mesh;
}

}  // namespace tissue
