#include "components.h"

#include "cut_lattice.h"
#include "tissue/base/disjoint_sets.h"

#include <algorithm>
#include <limits>

namespace tissue {
namespace {

// Inside points of one parity that follow each other along x.
struct RunOfPoints {
  std::int64_t first, last;
};

// The runs of every row: row 2·(y + size_y·z) + parity.
struct Rows {
  std::vector<RunOfPoints> runs;
  std::vector<std::uint32_t> begin;
};

Rows find_runs(const BccLattice& lattice, const std::vector<PointState>& states) {
  Rows rows;
  for (std::int64_t z = 0; z < lattice.size[2]; ++z) {
    for (std::int64_t y = 0; y < lattice.size[1]; ++y) {
      for (int parity = 0; parity < 2; ++parity) {
        rows.begin.push_back(static_cast<std::uint32_t>(rows.runs.size()));
        const PointState* row = &states[lattice.point(0, y, z, parity)];
        for (std::int64_t x = 0; x < lattice.size[0]; ++x) {
          if (row[2 * x] != kInside) continue;
          const std::int64_t first = x;
          while (x + 1 < lattice.size[0] && row[2 * (x + 1)] == kInside) ++x;
          rows.runs.push_back({first, x});
        }
      }
    }
  }
  rows.begin.push_back(static_cast<std::uint32_t>(rows.runs.size()));
  return rows;
}

// Unites runs of two rows where a point at x in `a` has a neighbour at x or x − `reach` in `b`.
void unite_rows(const Rows& rows, std::size_t a, std::size_t b, std::int64_t reach,
                DisjointSets& sets) {
  std::uint32_t i = rows.begin[a], j = rows.begin[b];
  while (i < rows.begin[a + 1] && j < rows.begin[b + 1]) {
    const RunOfPoints &here = rows.runs[i], &there = rows.runs[j];
    if (there.first <= here.last && there.last >= here.first - reach) sets.unite(i, j);
    if (there.last < here.last) {
      ++j;
    } else {
      ++i;
    }
  }
}

std::uint32_t chosen_set(const BccLattice& lattice, const Component& component, const Rows& rows,
                         DisjointSets& sets) {
  if (component.choice == Component::Choice::kNearest) {
    std::uint32_t nearest = 0;
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t row = 0; row + 1 < rows.begin.size(); ++row) {
      for (std::uint32_t r = rows.begin[row]; r < rows.begin[row + 1]; ++r) {
        const auto yz = static_cast<std::int64_t>(row / 2);
        for (std::int64_t x = rows.runs[r].first; x <= rows.runs[r].last; ++x) {
          const Vec3 place = lattice.place(
              lattice.point(x, yz % lattice.size[1], yz / lattice.size[1], row % 2 != 0));
          const double distance = (place - component.place).squaredNorm();
          if (!(distance < smallest)) continue;
          smallest = distance;
          nearest = r;
        }
      }
    }
    return sets.find(nearest);
  }
  std::vector<std::int64_t> points(rows.runs.size(), 0);
  for (std::uint32_t r = 0; r < rows.runs.size(); ++r) {
    points[sets.find(r)] += rows.runs[r].last - rows.runs[r].first + 1;
  }
  return static_cast<std::uint32_t>(std::max_element(points.begin(), points.end()) -
                                    points.begin());
}

}  // namespace

std::size_t keep_component(const BccLattice& lattice, const Component& component,
                           std::vector<PointState>& states) {
  if (component.choice == Component::Choice::kAll) return 0;
  const Rows rows = find_runs(lattice, states);
  if (rows.runs.empty()) return 0;
  DisjointSets sets(rows.runs.size());
  const auto row_of = [&](std::int64_t y, std::int64_t z, int parity) {
    return static_cast<std::size_t>(2 * (y + lattice.size[1] * z) + parity);
  };
  for (std::int64_t z = 1; z < lattice.size[2]; ++z) {
    for (std::int64_t y = 1; y < lattice.size[1]; ++y) {
      for (int parity = 0; parity < 2; ++parity) {
        unite_rows(rows, row_of(y, z, parity), row_of(y - 1, z, parity), 0, sets);
        unite_rows(rows, row_of(y, z, parity), row_of(y, z - 1, parity), 0, sets);
      }
      // The centres around a corner lie half a cell before and behind it along every axis.
      for (const auto& [dy, dz] : {std::array<int, 2>{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
        unite_rows(rows, row_of(y, z, 0), row_of(y - dy, z - dz, 1), 1, sets);
      }
    }
  }
  std::size_t components = 0;
  for (std::uint32_t r = 0; r < rows.runs.size(); ++r) components += sets.find(r) == r;
  if (components == 1) return 0;
  const std::uint32_t chosen = chosen_set(lattice, component, rows, sets);
  for (std::size_t row = 0; row + 1 < rows.begin.size(); ++row) {
    for (std::uint32_t r = rows.begin[row]; r < rows.begin[row + 1]; ++r) {
      if (sets.find(r) == chosen) continue;
      const auto yz = static_cast<std::int64_t>(row / 2);
      for (std::int64_t x = rows.runs[r].first; x <= rows.runs[r].last; ++x) {
        states[lattice.point(x, yz % lattice.size[1], yz / lattice.size[1], row % 2 != 0)] =
            kOutside;
      }
    }
  }
  return components - 1;
}

}  // namespace tissue
