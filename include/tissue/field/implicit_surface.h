#pragma once

#include "tissue/field/sample.h"

#include <memory>

namespace tissue {

/// The organ's boundary: where an implicit function f crosses zero. f < 0 inside. Beyond the outer
/// faces of the volume's voxels f > 0, so that an organ that touches the border gets a flat cap.
struct ImplicitSurface {
  std::shared_ptr<const Volume> field;
  double iso = 0.0;
  /// True where values above `iso` are inside, as in an image; false for a distance map.
  bool inside_above = true;
  /// Smallest and largest value of the field.
  std::array<double, 2> range = {0.0, 1.0};
};

/// Inside where the value is above `iso`. Throws InputError E_PARAM if `iso` is not finite and
/// E_EMPTY_SURFACE, with the range of the data, if no voxel is inside.
ImplicitSurface surface_at_iso(std::shared_ptr<const Volume> volume, double iso);

/// Inside where the mask is set. A `label` mask is a set of voxels (value above 0): the surface is
/// the zero of their signed distance map. Any other mask is a coverage, set where it is above half
/// of its largest value. Throws InputError E_EMPTY_SURFACE if nothing is set.
ImplicitSurface surface_of_mask(const std::shared_ptr<const Volume>& mask);

/// The volume of the voxels whose centres are inside [m³].
double voxel_volume_inside(const ImplicitSurface& surface);

/// Evaluates an implicit surface at places in the grid's frame [m].
template <class Sampler>
class ImplicitFunction {
 public:
  ImplicitFunction(const ImplicitSurface& surface, const Sampler& sampler)
      : sampler_(sampler), iso_(surface.iso), sign_(surface.inside_above ? -1.0 : 1.0) {
    const Grid& grid = surface.field->grid;
    low_ = -0.5 * grid.spacing;
    for (int axis = 0; axis < 3; ++axis) {
      high_[axis] = (static_cast<double>(grid.size[axis]) - 0.5) * grid.spacing[axis];
    }
    // The cap is a steep wall: its slope only has to have the sign right.
    const auto [low, high] = surface.range;
    cap_slope_ = std::max(high - low, std::abs(high)) / grid.spacing.minCoeff();
    if (!(cap_slope_ > 0.0)) cap_slope_ = 1.0;
  }

  double operator()(const Vec3& place) const {
    return std::max(field(place), cap_slope_ * beyond_border(place));
  }
  /// The value, and the gradient [1/m along the grid's axes].
  auto with_gradient(const Vec3& place) const {
    auto result = sampler_.with_gradient(place);
    result.value = sign_ * (result.value - iso_);
    result.gradient *= sign_;
    const double cap = cap_slope_ * beyond_border(place);
    if (cap > result.value) {
      Vec3 beyond = (low_ - place).cwiseMax(place - high_);
      int axis = 0;
      beyond.maxCoeff(&axis);
      result.value = cap;
      result.gradient = (place[axis] > high_[axis] ? 1.0 : -1.0) * cap_slope_ * Vec3::Unit(axis);
    }
    return result;
  }
  /// The function without the cap.
  double field(const Vec3& place) const { return sign_ * (sampler_(place) - iso_); }
  /// Distance to the outer faces of the voxels along the nearest axis [m], positive outside.
  double beyond_border(const Vec3& place) const {
    double beyond = low_[0] - place[0];
    for (int axis = 0; axis < 3; ++axis) {
      beyond = std::max(beyond, std::max(low_[axis] - place[axis], place[axis] - high_[axis]));
    }
    return beyond;
  }

 private:
  Sampler sampler_;
  double iso_, sign_, cap_slope_;
  Vec3 low_, high_;
};

/// Calls `body(f)` with the implicit function of the surface.
template <class Body>
decltype(auto) with_implicit_function(const ImplicitSurface& surface, Body&& body) {
  return with_sampler(*surface.field, [&](const auto& sampler) -> decltype(auto) {
    return body(ImplicitFunction<std::decay_t<decltype(sampler)>>(surface, sampler));
  });
}

/// Where f crosses zero between `a` and `b`, as the fraction of the way from `a`. `f_a` and `f_b`
/// have opposite signs; f changes sign within `tolerance` (a fraction too) of the result, which
/// depends on the order of the ends no more than that.
template <class Function>
double bracketed_root(const Function& f, const Vec3& a, const Vec3& b, double f_a, double f_b,
                      double tolerance = 1e-6) {
  // Illinois' variant of regula falsi: superlinear where f is smooth, and safe on steps.
  double low = 0.0, high = 1.0, previous = -1.0;
  int kept_end = 0;
  for (int i = 0; i < 100 && high - low > tolerance; ++i) {
    double t = (low * f_b - high * f_a) / (f_b - f_a);
    if (!(t > low && t < high)) t = 0.5 * (low + high);
    const double f_t = f(a + t * (b - a));
    if (f_t == 0.0) return t;
    const bool root_is_below = (f_t < 0.0) == (f_b < 0.0);
    // Steps are also short beside a plateau: only a change of sign close by is a root.
    if (std::abs(t - previous) < 0.1 * tolerance) {
      const double beside = std::clamp(root_is_below ? t - tolerance : t + tolerance, low, high);
      const double f_beside = f(a + beside * (b - a));
      if (f_beside == 0.0 || (f_beside < 0.0) != (f_t < 0.0)) return t;
      f_a = f_a < 0.0 ? -1.0 : 1.0;  // Forget the plateau: bisect.
      f_b = -f_a;
    }
    previous = t;
    if (root_is_below) {
      high = t;
      f_b = f_t;
      if (kept_end == -1) f_a *= 0.5;
      kept_end = -1;
    } else {
      low = t;
      f_a = f_t;
      if (kept_end == 1) f_b *= 0.5;
      kept_end = 1;
    }
  }
  return 0.5 * (low + high);
}

}  // namespace tissue
