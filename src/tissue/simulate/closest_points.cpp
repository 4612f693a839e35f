#include "closest_points.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>

namespace tissue {
namespace {

std::array<double, 3> closest_on_edges(const Vec3& point, const std::array<Vec3, 3>& corners) {
  std::array<double, 3> nearest = {1.0, 0.0, 0.0};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &from = corners[k], &to = corners[(k + 1) % 3];
    const double along = closest_of_segments(point, point, from, to).second;
    const double squared = (from + along * (to - from) - point).squaredNorm();
    if (squared >= least) continue;
    least = squared;
    nearest = {0.0, 0.0, 0.0};
    nearest[k] = 1.0 - along;
    nearest[(k + 1) % 3] = along;
  }
  return nearest;
}

}  // namespace

std::array<double, 3> closest_in_triangle(const Vec3& point, const Vec3& a, const Vec3& b,
                                          const Vec3& c) {
  const auto between = [](double from, double to) {
    return from - to > 0.0 ? std::clamp(from / (from - to), 0.0, 1.0) : 0.0;
  };
  const Vec3 ab = b - a, ac = c - a, ap = point - a, bp = point - b, cp = point - c;
  if (ab.cross(ac).squaredNorm() <= 1e-20 * ab.squaredNorm() * ac.squaredNorm()) {
    return closest_on_edges(point, {a, b, c});
  }
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {1.0, 0.0, 0.0};
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return {0.0, 1.0, 0.0};
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return {0.0, 0.0, 1.0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double v = between(d1, d3);
    return {1.0 - v, v, 0.0};
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double w = between(d2, d6);
    return {1.0 - w, 0.0, w};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double w = between(d4 - d3, d6 - d5);
    return {0.0, 1.0 - w, w};
  }
  const double v = vb / (va + vb + vc), w = vc / (va + vb + vc);
  return {1.0 - v - w, v, w};
}

AlongSegments closest_of_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 first = b - a, second = d - c, apart = a - c;
  const double aa = first.squaredNorm(), ee = second.squaredNorm(), f = second.dot(apart);
  const auto onto = [](double length, double squared) {
    return squared > 0.0 ? std::clamp(length / squared, 0.0, 1.0) : 0.0;
  };
  if (aa == 0.0) return {0.0, onto(f, ee)};
  const double along = first.dot(apart);
  if (ee == 0.0) return {onto(-along, aa), 0.0};
  const double both = first.dot(second);
  AlongSegments result;
  // Parallel ones are as near anywhere.
  result.first = onto(both * f - along * ee, std::max(aa * ee - both * both, 0.0));
  const double on_second = both * result.first + f;
  result.second = onto(on_second, ee);
  // Where the second ends, the first is nearest to that end.
  if (on_second < 0.0) result.first = onto(-along, aa);
  if (on_second > ee) result.first = onto(both - along, aa);
  return result;
}

}  // namespace tissue
