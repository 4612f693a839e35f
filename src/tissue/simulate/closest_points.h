#pragma once

#include "tissue/base/types.h"

#include <array>

namespace tissue {

/// Barycentric coordinates of the place in a triangle that is nearest to a point (Ericson,
/// Real-Time Collision Detection, 5.1.5). One without area counts as its edges.
std::array<double, 3> closest_in_triangle(const Vec3& point, const Vec3& a, const Vec3& b,
                                          const Vec3& c);

/// How far along two segments, from 0 to 1, they are nearest to each other (ibid., 5.1.9). Either
/// may be a point.
struct AlongSegments {
  double first = 0.0, second = 0.0;
};
AlongSegments closest_of_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace tissue
