#pragma once

#include "tissue/field/implicit_surface.h"

#include <array>

namespace tissue {

/// The nearest place on a surface, as far as a search along lines finds it.
struct SurfacePoint {
  Vec3 place = Vec3::Zero();
  /// From where the search began [m]; `reach` if nothing was found.
  double distance = 0.0;
  bool found = false;
};

/// Places are good to this fraction of half a voxel.
constexpr double kSurfaceTolerance = 1e-3;

/// Searches along one line, the unit vector `direction`: in a first step of `first` and then in
/// steps of `step` [m], until f changes its sign.
template <class Function>
SurfacePoint search_along(const Function& f, const Vec3& from, double f_from, const Vec3& direction,
                          double first, double step, double reach) {
  double before = 0.0, f_before = f_from;
  for (double distance = first; before < reach; distance += step) {
    const Vec3 here = from + distance * direction;
    const double f_here = f(here);
    if (f_here == 0.0 || (f_here < 0.0) != (f_before < 0.0)) {
      const Vec3 start = from + before * direction;
      const double t =
          f_here == 0.0 ? 1.0 : bracketed_root(f, start, here, f_before, f_here, kSurfaceTolerance);
      const double found = before + t * (distance - before);
      return {from + found * direction, found, found <= reach};
    }
    before = distance;
    f_before = f_here;
  }
  return {from, reach, false};
}

/// Towards the 26 neighbours in a cube, as unit vectors.
inline const std::array<Vec3, 26>& search_directions() {
  static const std::array<Vec3, 26> directions = [] {
    std::array<Vec3, 26> result;
    for (int i = 0; i < 26; ++i) {
      const int neighbour = i < 13 ? i : i + 1;
      result[i] = Vec3(neighbour % 3 - 1, neighbour / 3 % 3 - 1, neighbour / 9 - 1).normalized();
    }
    return result;
  }();
  return directions;
}

/// Newton's method along one line, begun by the slope: two or three steps where f is smooth. Gives
/// up where they do not settle to within `accuracy` [m], or lead back or farther than `limit`.
template <class Function>
SurfacePoint newton_along(const Function& f, const Vec3& from, double f_from, double slope,
                          const Vec3& direction, double accuracy, double limit) {
  double before = 0.0, f_before = std::abs(f_from), distance = f_before / slope;
  for (int i = 0; i < 4 && distance > 0.0 && distance <= limit; ++i) {
    // Positive on the side of the start.
    const double f_here = std::copysign(1.0, f_from) * f(from + distance * direction);
    const double next = distance - f_here * (distance - before) / (f_here - f_before);
    if (std::abs(next - distance) <= accuracy) return {from + next * direction, next, true};
    before = distance;
    f_before = f_here;
    distance = next;
  }
  return {from, 0.0, false};
}

/// The first crossing along the gradient of f, or where there is none within `reach` [m] the
/// nearest crossing in 26 directions. `voxel` is the smallest spacing of the field [m]; `accuracy`
/// is a fraction of it.
template <class Function>
SurfacePoint search_surface(const Function& f, const Vec3& from, double voxel, double reach,
                            double accuracy = 1e-3) {
  const auto [value, gradient] = f.with_gradient(from);
  if (value == 0.0) return {from, 0.0, true};
  const double step = 0.5 * voxel, slope = gradient.norm();
  if (slope > 0.0) {
    const double estimate = std::abs(value) / slope;
    const Vec3 downhill = (value > 0.0 ? -1.0 : 1.0) / slope * gradient;
    if (estimate < accuracy * voxel) return {from + estimate * downhill, estimate, true};
    // Within a voxel there is hardly more than one crossing to be found.
    const SurfacePoint near =
        newton_along(f, from, value, slope, downhill, accuracy * voxel, std::min(voxel, reach));
    if (near.found) return near;
    const double first = std::min(1.3 * estimate, step);
    const SurfacePoint found = search_along(f, from, value, downhill, first, step, reach);
    if (found.found) return found;
  }
  // All 26 directions a step farther each time, so that what is near is found soon.
  SurfacePoint nearest = {from, reach, false};
  for (double before = 0.0; before < reach && !nearest.found; before += step) {
    for (const Vec3& unit : search_directions()) {
      const Vec3 near = from + before * unit;
      const double f_far = f(near + step * unit);
      if (f_far != 0.0 && (f_far < 0.0) == (value < 0.0)) continue;
      const SurfacePoint found = search_along(f, near, f(near), unit, step, step, step);
      const double distance = before + found.distance;
      if (found.found && distance < nearest.distance) nearest = {found.place, distance, true};
    }
  }
  return nearest;
}

}  // namespace tissue
