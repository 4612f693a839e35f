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

 private:
  double low_, d_max_, scale_;
};

/// The window that does not depend on the encoding: the identity if all values lie in [0, d_max],
/// else the range of the voxels inside the surface.
DensityWindow default_window(const Volume& volume, const ImplicitSurface& surface, double d_max);

/// The mean density over a tet, by the midpoint rule on its 8^k congruent parts: k grows with the
/// tet's size until a part's long edge is at most 4 voxels: a part then holds about five, and a
/// trilinear sample blends eight.
class TetSampling {
 public:
  /// `edge` is the tet's long edge [m]; `spacing` that of the voxels.
  TetSampling(double edge, const Vec3& spacing);

  template <class Function>
  double mean(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d,
              const Function& density) const {
    double sum = 0.0;
    for (const Eigen::Vector4d& w : weights_) {
      sum += density(w[0] * a + w[1] * b + w[2] * c + w[3] * d);
    }
    return sum / static_cast<double>(weights_.size());
  }

 private:
  std::vector<Eigen::Vector4d> weights_;
};

}  // namespace tissue
