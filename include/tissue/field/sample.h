#pragma once

#include "tissue/field/volume.h"

#include <algorithm>
#include <utility>

namespace tissue {

/// The trilinear interpolant of the voxels' values; outside the voxel centres the nearest place on
/// their hull counts.
template <class T>
class TrilinearSampler {
 public:
  explicit TrilinearSampler(const Volume& volume)
      : data_(std::get<std::vector<T>>(volume.voxels).data()),
        slope_(volume.slope),
        intercept_(volume.intercept) {
    const Grid& grid = volume.grid;
    std::ptrdiff_t stride = 1;
    for (int axis = 0; axis < 3; ++axis) {
      inverse_spacing_[axis] = 1.0 / grid.spacing[axis];
      last_[axis] = static_cast<double>(grid.size[axis] - 1);
      // Along an axis of one voxel the two neighbours are the same voxel.
      step_[axis] = grid.size[axis] > 1 ? stride : 0;
      last_cell_[axis] = grid.size[axis] > 1 ? static_cast<int>(grid.size[axis]) - 2 : 0;
      stride *= grid.size[axis];
    }
    row_ = grid.size[0];
    slice_ = row_ * grid.size[1];
  }

  /// `place` is in the grid's frame [m].
  double operator()(const Vec3& place) const {
    double fraction[3];
    int cell[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double index = std::clamp(place[axis] * inverse_spacing_[axis], 0.0, last_[axis]);
      cell[axis] = std::min(static_cast<int>(index), last_cell_[axis]);
      fraction[axis] = index - cell[axis];
    }
    const T* corner = data_ + cell[0] + cell[1] * row_ + cell[2] * slice_;
    const auto along_x = [&](const T* p) {
      const double low = static_cast<double>(p[0]);
      return low + fraction[0] * (static_cast<double>(p[step_[0]]) - low);
    };
    const auto along_y = [&](const T* p) {
      const double low = along_x(p);
      return low + fraction[1] * (along_x(p + step_[1]) - low);
    };
    const double low = along_y(corner);
    return slope_ * (low + fraction[2] * (along_y(corner + step_[2]) - low)) + intercept_;
  }

 private:
  const T* data_;
  double slope_, intercept_;
  double inverse_spacing_[3], last_[3];
  int last_cell_[3];
  std::ptrdiff_t step_[3], row_ = 1, slice_ = 1;
};

/// The value of the nearest voxel: labels must not be blended.
template <class T>
class NearestSampler {
 public:
  explicit NearestSampler(const Volume& volume)
      : data_(std::get<std::vector<T>>(volume.voxels).data()),
        grid_(&volume.grid),
        slope_(volume.slope),
        intercept_(volume.intercept) {}

  /// `place` is in the grid's frame [m].
  double operator()(const Vec3& place) const {
    std::size_t voxel[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double last = static_cast<double>(grid_->size[axis] - 1);
      const double index = std::clamp(place[axis] / grid_->spacing[axis], 0.0, last);
      voxel[axis] = static_cast<std::size_t>(index + 0.5);
    }
    const std::size_t i = voxel[0] + grid_->size[0] * (voxel[1] + grid_->size[1] * voxel[2]);
    return slope_ * static_cast<double>(data_[i]) + intercept_;
  }

 private:
  const T* data_;
  const Grid* grid_;
  double slope_, intercept_;
};

/// Calls `body(sampler)` with the sampler that fits the volume's voxel type and quantity, so that a
/// loop over many places decides once.
template <class Body>
decltype(auto) with_sampler(const Volume& volume, Body&& body) {
  return std::visit(
      [&](const auto& values) -> decltype(auto) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        if (volume.quantity == Quantity::kLabel) return body(NearestSampler<T>(volume));
        return body(TrilinearSampler<T>(volume));
      },
      volume.voxels);
}

}  // namespace tissue
