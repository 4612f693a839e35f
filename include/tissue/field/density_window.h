#pragma once

#include "tissue/field/implicit_surface.h"

namespace tissue {

/// Maps values to densities: `low` to 0 and `high` to `d_max`, linearly, clamped to [1, d_max], so
/// that a density is always positive.
class DensityWindow {
 public:
  DensityWindow(double low, double high, double d_max)
      : low_(low), d_max_(d_max), scale_(d_max / (high - low)) {}

  double density(double value) const { return std::clamp((value - low_) * scale_, 1.0, d_max_); }

  /// The same for `count` values in place.
  void apply(float* values, int count) const {
    const auto low = static_cast<float>(low_), scale = static_cast<float>(scale_),
               d_max = static_cast<float>(d_max_);
    for (int i = 0; i < count; ++i) {
      values[i] = std::min(std::max((values[i] - low) * scale, 1.0f), d_max);
    }
  }

 private:
  double low_, d_max_, scale_;
};

/// The window that does not depend on the encoding: the identity if all values lie in [0, d_max],
/// else the range of the voxels inside the surface.
DensityWindow default_window(const Volume& volume, const ImplicitSurface& surface, double d_max);

}  // namespace tissue
