#include "tissue/field/density_window.h"

#include <cmath>
#include <limits>

namespace tissue {
namespace {

using Corners = Eigen::Matrix4d;  // Columns are the barycentric coordinates of a tet's corners.

// Centroids of the 8^splits parts of a tet that is split at its edge midpoints again and again.
void append_centroids(const Corners& tet, int splits, std::vector<Eigen::Vector4d>& centroids) {
  if (splits == 0) {
    centroids.push_back(tet.rowwise().mean());
    return;
  }
  const auto part = [&](int a0, int a1, int b0, int b1, int c0, int c1, int d0, int d1) {
    Corners corners;
    corners << 0.5 * (tet.col(a0) + tet.col(a1)), 0.5 * (tet.col(b0) + tet.col(b1)),
        0.5 * (tet.col(c0) + tet.col(c1)), 0.5 * (tet.col(d0) + tet.col(d1));
    append_centroids(corners, splits - 1, centroids);
  };
  part(0, 0, 0, 1, 0, 2, 0, 3);
  part(0, 1, 1, 1, 1, 2, 1, 3);
  part(0, 2, 1, 2, 2, 2, 2, 3);
  part(0, 3, 1, 3, 2, 3, 3, 3);
  part(0, 1, 0, 2, 0, 3, 1, 3);
  part(0, 1, 0, 2, 1, 2, 1, 3);
  part(0, 2, 0, 3, 1, 3, 2, 3);
  part(0, 2, 1, 2, 1, 3, 2, 3);
}

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

TetSampling::TetSampling(double edge, const Vec3& spacing) {
  const double voxels = edge / std::cbrt(spacing.prod());
  const int splits = std::clamp(static_cast<int>(std::ceil(std::log2(voxels / 4.0))), 0, 3);
  append_centroids(Corners::Identity(), splits, weights_);
}

}  // namespace tissue
