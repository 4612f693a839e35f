#pragma once

#include "tissue/simulate/body.h"

#include <optional>

namespace tissue {

/// Finds where a ball touches a body's rest surface.
class SurfaceTouch {
 public:
  explicit SurfaceTouch(const Body& body);

  /// The surface vertex nearest to `centre`, if the surface itself is within `radius` of it [m].
  std::optional<std::uint32_t> target(const Vec3& centre, double radius) const;

 private:
  const Body* body_;
  std::vector<std::uint32_t> vertices_;
  Vec3f low_, high_;
  double longest_edge_ = 0.0;
};

/// Distance from a point to a triangle.
double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace tissue
