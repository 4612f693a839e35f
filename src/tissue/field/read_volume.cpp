#include "tissue/field/read_volume.h"

#include "itk_bridge.h"
#include "tissue/base/error.h"

#include <Eigen/LU>

#include <algorithm>

namespace tissue {
namespace {

constexpr double kMetresPerMillimetre = 1e-3;

Grid grid_of(const ImageFile& file, const std::string& path) {
  const Vec3 ras_from_lps(-1.0, -1.0, 1.0);
  Grid grid;
  grid.size = file.size;
  for (int i = 0; i < 3; ++i) {
    grid.spacing[i] = file.spacing[i] * kMetresPerMillimetre;
    grid.origin[i] = ras_from_lps[i] * file.origin[i] * kMetresPerMillimetre;
    for (int j = 0; j < 3; ++j) grid.axes(i, j) = ras_from_lps[i] * file.direction[i][j];
  }
  if (!((grid.axes.transpose() * grid.axes - Mat3::Identity()).cwiseAbs().maxCoeff() <= 1e-4)) {
    throw InputError(ErrorCode::kDirection,
                     "volume: the direction matrix of '" + path + "' is not orthonormal");
  }
  return grid;
}

void reverse_first_axis(Grid& grid, Voxels& voxels) {
  grid.origin += grid.axes.col(0) * grid.spacing[0] * (grid.size[0] - 1.0);
  grid.axes.col(0) *= -1.0;
  const auto row = static_cast<std::ptrdiff_t>(grid.size[0]);
  std::visit(
      [row](auto& values) {
        for (auto begin = values.begin(); begin != values.end(); begin += row) {
          std::reverse(begin, begin + row);
        }
      },
      voxels);
}

}  // namespace

Volume read_volume(const std::string& path) {
  ImageFile file = read_image(path);
  Volume volume;
  volume.grid = grid_of(file, path);
  volume.voxels = std::move(file.voxels);
  if (volume.grid.axes.determinant() < 0.0) reverse_first_axis(volume.grid, volume.voxels);
  check_volume(volume);
  return volume;
}

}  // namespace tissue
