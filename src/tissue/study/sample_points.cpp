#include "tissue/study/sample_points.h"

#include "tissue/base/disjoint_sets.h"
#include "tissue/base/error.h"
#include "tissue/field/density_window.h"
#include "tissue/refine/levels.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

namespace tissue {
namespace {

using Inside = std::function<bool(const Vec3&)>;
using Cell = std::array<int, 3>;

// Middles of the cells of a grid over the volume, in the grid's frame, that are inside.
std::vector<Cell> cells_inside(const Grid& grid, double step, const Inside& inside) {
  std::array<int, 3> counts{};
  for (int axis = 0; axis < 3; ++axis) {
    counts[axis] =
        1 + static_cast<int>(grid.spacing[axis] * static_cast<double>(grid.size[axis] - 1) / step);
  }
  std::vector<Cell> cells;
  for (int z = 0; z < counts[2]; ++z) {
    for (int y = 0; y < counts[1]; ++y) {
      for (int x = 0; x < counts[0]; ++x) {
        if (inside(step * Vec3(x + 0.5, y + 0.5, z + 0.5))) cells.push_back({x, y, z});
      }
    }
  }
  return cells;
}

// The largest set of cells that touch by their sides, in order.
std::vector<Cell> largest_part(const std::vector<Cell>& cells) {
  std::map<Cell, std::uint32_t> number;
  for (std::uint32_t i = 0; i < cells.size(); ++i) number[cells[i]] = i;
  DisjointSets parts(cells.size());
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Cell next = cells[i];
      ++next[axis];
      const auto found = number.find(next);
      if (found != number.end()) parts.unite(i, found->second);
    }
  }
  std::vector<std::size_t> sizes(cells.size(), 0);
  for (std::uint32_t i = 0; i < cells.size(); ++i) ++sizes[parts.find(i)];
  const auto largest =
      static_cast<std::uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  std::vector<Cell> part;
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    if (parts.find(i) == largest) part.push_back(cells[i]);
  }
  return part;
}

std::vector<Vec3> in_world(const Grid& grid, double step, const std::vector<Cell>& cells) {
  std::vector<Vec3> points;
  for (const Cell& cell : cells) {
    points.push_back(grid.to_world(step * Vec3(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5)));
  }
  return points;
}

}  // namespace

SamplePoints sample_points(const Volume& volume, const ImplicitSurface& surface,
                           const SamplePointOptions& options) {
  const Grid& grid = volume.grid;
  const DensityWindow window = default_window(volume, surface, LevelOptions().d_max);
  return with_implicit_function(surface, [&](const auto& f) {
    return with_sampler(volume, [&](const auto& value) {
      const Inside in_organ = [&](const Vec3& place) { return f(place) < 0.0; };
      const Inside in_tumour = [&](const Vec3& place) {
        return in_organ(place) && window.density(value(place)) > options.tumour_above;
      };
      SamplePoints points;
      const double organ_step = std::cbrt(voxel_volume_inside(surface) / options.organ);
      points.organ =
          in_world(grid, organ_step, largest_part(cells_inside(grid, organ_step, in_organ)));
      // How large the tumour is, the voxels say.
      const double voxel = std::cbrt(grid.spacing.prod());
      const std::size_t voxels = cells_inside(grid, voxel, in_tumour).size();
      if (voxels == 0) {
        throw InputError(ErrorCode::kParam,
                         "tumour_above: no tissue is denser than " + to_text(options.tumour_above));
      }
      const double tumour_step = voxel * std::cbrt(static_cast<double>(voxels) / options.tumour);
      points.tumour = in_world(grid, tumour_step, cells_inside(grid, tumour_step, in_tumour));
      return points;
    });
  });
}

}  // namespace tissue
