#pragma once

#include "tissue/field/volume.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace tissue {

/// Up to 64 places in the grid's frame [m], one array per coordinate, so that loops over them
/// vectorise.
struct PlaceBatch {
  static constexpr int kCapacity = 64;
  int count = 0;
  alignas(64) float x[kCapacity] = {};
  alignas(64) float y[kCapacity] = {};
  alignas(64) float z[kCapacity] = {};
};

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
    const Location at = locate(place);
    const auto along_x = [&](const T* p) {
      const double low = static_cast<double>(p[0]);
      return low + at.fraction[0] * (static_cast<double>(p[step_[0]]) - low);
    };
    const auto along_y = [&](const T* p) {
      const double low = along_x(p);
      return low + at.fraction[1] * (along_x(p + step_[1]) - low);
    };
    const double low = along_y(at.corner);
    return slope_ * (low + at.fraction[2] * (along_y(at.corner + step_[2]) - low)) + intercept_;
  }

  struct ValueAndGradient {
    double value;
    /// Per metre along the grid's axes.
    Vec3 gradient;
  };
  ValueAndGradient with_gradient(const Vec3& place) const {
    const Location at = locate(place);
    double corner[8];
    for (int i = 0; i < 8; ++i) {
      corner[i] = static_cast<double>(
          at.corner[(i & 1) * step_[0] + (i >> 1 & 1) * step_[1] + (i >> 2) * step_[2]]);
    }
    // Blends away one axis after the other; what differs along it is the gradient.
    const double u = at.fraction[0], v = at.fraction[1], w = at.fraction[2];
    double along_x[4], dx[4];
    for (int i = 0; i < 4; ++i) {
      dx[i] = corner[2 * i + 1] - corner[2 * i];
      along_x[i] = corner[2 * i] + u * dx[i];
    }
    const double dy[2] = {along_x[1] - along_x[0], along_x[3] - along_x[2]};
    const double low = along_x[0] + v * dy[0], high = along_x[2] + v * dy[1];
    const Vec3 difference(
        (1 - w) * ((1 - v) * dx[0] + v * dx[1]) + w * ((1 - v) * dx[2] + v * dx[3]),
        (1 - w) * dy[0] + w * dy[1], high - low);
    ValueAndGradient result;
    result.value = slope_ * (low + w * (high - low)) + intercept_;
    for (int axis = 0; axis < 3; ++axis) {
      result.gradient[axis] = slope_ * difference[axis] * inverse_spacing_[axis];
    }
    return result;
  }

  /// What interpolation of these voxels in bulk is done in: floats hold every 16-bit value.
  using Real = std::conditional_t<sizeof(T) <= 2 || std::is_same_v<T, float>, float, double>;

  /// The cells that hold the places of a batch: the low corner of each, and where in it the place
  /// is, from 0 to 1.
  struct Cells {
    int count = 0;
    std::array<const T*, PlaceBatch::kCapacity> corner;
    alignas(64) std::array<std::array<float, PlaceBatch::kCapacity>, 3> fraction;
  };

  /// Finds the cells, good to a ten-thousandth of a voxel, and asks for their voxels, so that they
  /// come from memory while another batch is interpolated.
  void locate(const PlaceBatch& places, Cells& cells) const {
    constexpr int kCapacity = PlaceBatch::kCapacity;
    alignas(64) int cell[3][kCapacity];
    const float* coordinates[3] = {places.x, places.y, places.z};
    for (int axis = 0; axis < 3; ++axis) {
      const auto scale = static_cast<float>(inverse_spacing_[axis]);
      const auto last = static_cast<float>(last_[axis]);
      const int last_cell = last_cell_[axis];
      float* __restrict__ fraction = cells.fraction[axis].data();
      for (int i = 0; i < kCapacity; ++i) {
        const float index = std::min(std::max(coordinates[axis][i] * scale, 0.0f), last);
        cell[axis][i] = std::min(static_cast<int>(index), last_cell);
        fraction[i] = index - static_cast<float>(cell[axis][i]);
      }
    }
    cells.count = places.count;
    for (int i = 0; i < places.count; ++i) {
      const T* corner = data_ + cell[0][i] + cell[1][i] * row_ + cell[2][i] * slice_;
      cells.corner[i] = corner;
      // Two neighbours along x share a line of the cache, mostly.
      __builtin_prefetch(corner);
      __builtin_prefetch(corner + step_[1]);
      __builtin_prefetch(corner + step_[2]);
      __builtin_prefetch(corner + step_[1] + step_[2]);
    }
  }

  /// The values at all places of a batch, several times faster than one by one.
  void interpolate(const Cells& cells, float* values) const {
    constexpr int kCapacity = PlaceBatch::kCapacity;
    // Gathered in the type in which they are stored, two at a time; converting them vectorises.
    struct Pair {
      T low, high;
    };
    alignas(64) Pair corner[4][kCapacity] = {};
    for (int i = 0; i < cells.count; ++i) {
      const T* p = cells.corner[i];
      const T* edges[4] = {p, p + step_[1], p + step_[2], p + step_[1] + step_[2]};
      for (int k = 0; k < 4; ++k) {
        if (step_[0] == 1) {
          std::memcpy(&corner[k][i], edges[k], sizeof(Pair));
        } else {
          corner[k][i] = {*edges[k], *edges[k]};
        }
      }
    }
    const auto blend = [](Real low, Real high, float t) {
      return low + static_cast<Real>(t) * (high - low);
    };
    const auto slope = static_cast<Real>(slope_), intercept = static_cast<Real>(intercept_);
    for (int i = 0; i < kCapacity; ++i) {
      const float u = cells.fraction[0][i], v = cells.fraction[1][i];
      const auto along_x = [&](int k) {
        return blend(static_cast<Real>(corner[k][i].low), static_cast<Real>(corner[k][i].high), u);
      };
      const Real low = blend(along_x(0), along_x(1), v), high = blend(along_x(2), along_x(3), v);
      values[i] = static_cast<float>(slope * blend(low, high, cells.fraction[2][i]) + intercept);
    }
  }

 private:
  // The low corner of the cell that holds a place, and where in the cell it is, from 0 to 1.
  struct Location {
    const T* corner;
    double fraction[3];
  };
  Location locate(const Vec3& place) const {
    Location at = {data_, {}};
    const std::ptrdiff_t strides[3] = {1, row_, slice_};
    for (int axis = 0; axis < 3; ++axis) {
      const double index = std::clamp(place[axis] * inverse_spacing_[axis], 0.0, last_[axis]);
      const int cell = std::min(static_cast<int>(index), last_cell_[axis]);
      at.fraction[axis] = index - cell;
      at.corner += cell * strides[axis];
    }
    return at;
  }

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

  struct ValueAndGradient {
    double value;
    Vec3 gradient;
  };
  /// A step function has no slope.
  ValueAndGradient with_gradient(const Vec3& place) const { return {(*this)(place), Vec3::Zero()}; }

  using Cells = PlaceBatch;
  void locate(const PlaceBatch& places, Cells& cells) const { cells = places; }
  /// The values at all places of a batch.
  void interpolate(const Cells& places, float* values) const {
    for (int i = 0; i < places.count; ++i) {
      const Eigen::Vector3f place(places.x[i], places.y[i], places.z[i]);
      values[i] = static_cast<float>((*this)(Vec3(place.cast<double>())));
    }
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
