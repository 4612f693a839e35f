#include "cut_lattice.h"

#include "components.h"
#include "tissue/base/parallel.h"

#include <algorithm>
#include <numeric>

namespace tissue {
namespace {

// A cut point that is nearer to an end of its edge than this fraction of the edge's length pulls
// the end onto the surface. The pair keeps dihedral angles within 10.76° and 164.70° (Labelle and
// Shewchuk 2007, the bound of their abstract).
constexpr double kAlphaLong = 0.285;
constexpr double kAlphaShort = 0.399;

// Cuts are good to this fraction of an edge.
constexpr double kTolerance = 1e-5;

constexpr std::uint32_t kNone = 0xffffffffu;

double alpha(int direction) { return direction < 3 ? kAlphaLong : kAlphaShort; }

struct Cut {
  std::int64_t point;
  int direction;
  // Fraction of the edge from its canonical start.
  double t;
};

class Cutter {
 public:
  Cutter(const ImplicitSurface& surface, const BccLattice& lattice, const Run& run)
      : surface_(surface), run_(run) {
    result_.lattice = lattice;
    for (int parity = 0; parity < 2; ++parity) {
      for (int d = 0; d < BccLattice::kDirections; ++d) {
        result_.offsets[parity][d] = lattice.offset(parity, BccLattice::kStep[d]);
      }
    }
    points_per_layer_ = 2 * lattice.size[0] * lattice.size[1];
    layers_ = lattice.size[2];
  }

  CutLattice cut(const Component& component) {
    with_implicit_function(surface_, [&](const auto& f) {
      find_states(f);
      find_cuts(f);
    });
    warp();
    result_.components_dropped = keep_component(result_.lattice, component, result_.states);
    place_vertices();
    return std::move(result_);
  }

 private:
  // Calls body(layer, first point, point behind the last) for the layers that have one on either
  // side, without their first and last rows, so that every edge of these points stays within.
  template <class Body>
  void for_each_layer(const Body& body) const {
    const std::int64_t row = 2 * result_.lattice.size[0];
    parallel_ranges(
        static_cast<std::size_t>(layers_ - 2), 1, run_, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            const auto layer = static_cast<std::int64_t>(i) + 1;
            body(layer, layer * points_per_layer_ + row, (layer + 1) * points_per_layer_ - row);
          }
        });
  }

  template <class Function>
  void find_states(const Function& f) {
    const BccLattice& lattice = result_.lattice;
    // The edge of one point of the margin leads to the point behind the last.
    result_.states.assign(lattice.point_count() + 2, kOutside);
    std::vector<std::uint8_t> touched(layers_, 0);
    for_each_layer([&](std::int64_t z, std::int64_t, std::int64_t) {
      for (std::int64_t y = 1; y < lattice.size[1] - 1; ++y) {
        for (std::int64_t x = 1; x < lattice.size[0] - 1; ++x) {
          for (int parity = 0; parity < 2; ++parity) {
            const Vec3 place = lattice.place(x, y, z, parity);
            const double value = f(place);
            result_.states[lattice.point(x, y, z, parity)] = value > 0.0   ? kOutside
                                                             : value < 0.0 ? kInside
                                                                           : kOn;
            if (value > 0.0 && touched[z] == 0 && f.beyond_border(place) > 0.0) {
              touched[z] = f.field(place) < 0.0;
            }
          }
        }
      }
    });
    result_.border_touched = std::find(touched.begin(), touched.end(), 1) != touched.end();
  }

  template <class Function>
  void find_cuts(const Function& f) {
    result_.marks.assign(result_.lattice.point_count(), 0);
    std::vector<std::size_t> counts(layers_ + 1, 0);
    for_each_layer([&](std::int64_t layer, std::int64_t begin, std::int64_t end) {
      for (std::int64_t point = begin; point < end; ++point) {
        result_.marks[point] = cut_directions(point);
        counts[layer] += static_cast<std::size_t>(__builtin_popcount(result_.marks[point]));
      }
    });
    first_cut_ = starts(counts);
    cuts_.resize(first_cut_.back());
    for_each_layer([&](std::int64_t layer, std::int64_t begin, std::int64_t end) {
      std::size_t next = first_cut_[layer];
      for (std::int64_t point = begin; point < end; ++point) {
        for (unsigned left = result_.marks[point]; left != 0; left &= left - 1) {
          const int d = __builtin_ctz(left);
          const Vec3 a = result_.lattice.place(point), b = result_.lattice.place(end_of(point, d));
          cuts_[next++] = {point, d, bracketed_root(f, a, b, f(a), f(b), kTolerance)};
        }
      }
    });
  }

  // Moves every violated point to the nearest cut that violates it (on a tie, the one on the lowest
  // edge). All decisions rest on the states before any warp, so that no order matters.
  void warp() {
    std::vector<std::uint32_t>& warped_to = result_.first_vertex;  // Until they are numbered.
    warped_to.assign(result_.marks.size(), kNone);
    std::vector<std::int64_t> moved;
    const auto distance_to = [&](const Cut& cut, std::int64_t point) {
      const double fraction = cut.point == point ? cut.t : 1.0 - cut.t;
      return fraction * BccLattice::edge_length(cut.direction, 1.0);
    };
    for (std::uint32_t c = 0; c < cuts_.size(); ++c) {
      const Cut& cut = cuts_[c];
      const double limit = alpha(cut.direction) * BccLattice::edge_length(cut.direction, 1.0);
      for (const std::int64_t point : {cut.point, end_of(cut.point, cut.direction)}) {
        const double distance = distance_to(cut, point);
        if (!(distance < limit)) continue;
        if (warped_to[point] == kNone) {
          moved.push_back(point);
        } else if (!(distance < distance_to(cuts_[warped_to[point]], point))) {
          continue;
        }
        warped_to[point] = c;
      }
    }
    for (const std::int64_t point : moved) result_.states[point] = kWarped;
  }

  // Marks what becomes a vertex, numbers and places it.
  void place_vertices() {
    const std::vector<PointState>& states = result_.states;
    std::vector<std::size_t> counts(layers_ + 1, 0);
    for_each_layer([&](std::int64_t layer, std::int64_t begin, std::int64_t end) {
      for (std::int64_t point = begin; point < end; ++point) {
        std::uint8_t& marks = result_.marks[point];
        if (marks != 0) marks = cut_directions(point);
        if (states[point] == kInside || (states[point] != kOutside && touches_inside(point))) {
          marks |= CutLattice::kVertexMark;
        }
        counts[layer] += static_cast<std::size_t>(__builtin_popcount(marks));
      }
    });
    const std::vector<std::size_t> first = starts(counts);
    result_.vertices.resize(first.back());
    result_.on_surface.assign(first.back(), 1);
    for_each_layer([&](std::int64_t layer, std::int64_t begin, std::int64_t end) {
      auto next = static_cast<std::uint32_t>(first[layer]);
      std::size_t cut = first_cut_[layer];
      for (std::int64_t point = begin; point < end; ++point) {
        const std::uint32_t warped_to = result_.first_vertex[point];
        result_.first_vertex[point] = next;
        const std::uint8_t marks = result_.marks[point];
        if ((marks & CutLattice::kVertexMark) != 0) {
          result_.on_surface[next] = states[point] != kInside;
          result_.vertices[next++] =
              states[point] == kWarped ? place_of(cuts_[warped_to]) : result_.lattice.place(point);
        }
        for (; cut < first_cut_[layer + 1] && cuts_[cut].point == point; ++cut) {
          if ((marks >> cuts_[cut].direction & 1u) != 0)
            result_.vertices[next++] = place_of(cuts_[cut]);
        }
      }
    });
  }

  std::uint8_t cut_directions(std::int64_t point) const {
    const PointState here = result_.states[point];
    unsigned directions = 0;
    if (here == kInside || here == kOutside) {
      const auto& offsets = result_.offsets[point & 1];
      for (int d = 0; d < BccLattice::kDirections; ++d) {
        if (result_.states[point + offsets[d]] == -here) directions |= 1u << d;
      }
    }
    return static_cast<std::uint8_t>(directions);
  }
  bool touches_inside(std::int64_t point) const {
    for (int d = 0; d < BccLattice::kDirections; ++d) {
      // Whoever has this point at the end of its edge has the parity from which the step leads
      // here.
      const int parity = (static_cast<int>(point & 1) + BccLattice::kStep[d][0]) & 1;
      if (result_.states[point + result_.offsets[point & 1][d]] == kInside ||
          result_.states[point - result_.offsets[parity][d]] == kInside) {
        return true;
      }
    }
    return false;
  }
  std::int64_t end_of(std::int64_t point, int direction) const {
    return point + result_.offsets[point & 1][direction];
  }
  Vec3 place_of(const Cut& cut) const {
    const Vec3 a = result_.lattice.place(cut.point),
               b = result_.lattice.place(end_of(cut.point, cut.direction));
    return a + cut.t * (b - a);
  }
  static std::vector<std::size_t> starts(const std::vector<std::size_t>& counts) {
    std::vector<std::size_t> result(counts.size() + 1, 0);
    std::partial_sum(counts.begin(), counts.end(), result.begin() + 1);
    return result;
  }

  const ImplicitSurface& surface_;
  const Run& run_;
  CutLattice result_;
  std::int64_t points_per_layer_ = 0, layers_ = 0;
  std::vector<std::size_t> first_cut_;
  std::vector<Cut> cuts_;
};

}  // namespace

CutLattice cut_lattice(const ImplicitSurface& surface, const BccLattice& lattice,
                       const Component& component, const Run& run) {
  return Cutter(surface, lattice, run).cut(component);
}

}  // namespace tissue
