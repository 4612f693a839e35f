#include "tissue/field/density_window.h"

#include <cmath>
#include <limits>

namespace tissue {
namespace {

// Smallest and largest value among the voxels inside the surface.
std::array<double, 2> range_inside(const Volume& volume, const ImplicitSurface& surface) {
  return with_sampler(volume, [&](const auto& value) {
    return with_implicit_function(surface, [&](const auto& f) {
      std::array<double, 2> range = {std::numeric_limits<double>::infinity(),
                                     -std::numeric_limits<double>::infinity()};
      const auto& size = volume.grid.size;
      for (std::uint32_t z = 0; z < size[2]; ++z) {
        for (std::uint32_t y = 0; y < size[1]; ++y) {
          for (std::uint32_t x = 0; x < size[0]; ++x) {
            const Vec3 place = Vec3(x, y, z).cwiseProduct(volume.grid.spacing);
            if (!(f.field(place) < 0.0)) continue;
            range[0] = std::min(range[0], value(place));
            range[1] = std::max(range[1], value(place));
          }
        }
      }
      return range;
    });
  });
}

}  // namespace

DensityWindow default_window(const Volume& volume, const ImplicitSurface& surface, double d_max) {
  const std::array<double, 2> all =
      &volume == surface.field.get() ? surface.range : value_range(volume);
  if (all[0] >= 0.0 && all[1] <= d_max) return {0.0, d_max, d_max};
  const std::array<double, 2> inside = range_inside(volume, surface);
  if (inside[1] > inside[0]) return {inside[0], inside[1], d_max};
  return {inside[0] - 1.0, inside[0], d_max};
}

}  // namespace tissue
