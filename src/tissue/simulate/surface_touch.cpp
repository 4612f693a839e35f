#include "tissue/simulate/surface_touch.h"

#include "closest_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tissue {

SurfaceTouch::SurfaceTouch(const Body& body) : body_(&body) {
  std::vector<std::uint8_t> on_surface(body.rest.size(), 0);
  for (const Triangle& triangle : body.surface) {
    for (int i = 0; i < 3; ++i) {
      on_surface[triangle[i]] = 1;
      const Vec3f edge = body.rest[triangle[i]] - body.rest[triangle[(i + 1) % 3]];
      longest_edge_ = std::max(longest_edge_, static_cast<double>(edge.norm()));
    }
  }
  low_ = Vec3f::Constant(std::numeric_limits<float>::infinity());
  high_ = -low_;
  for (std::uint32_t v = 0; v < body.rest.size(); ++v) {
    if (on_surface[v] == 0) continue;
    vertices_.push_back(v);
    low_ = low_.cwiseMin(body.rest[v]);
    high_ = high_.cwiseMax(body.rest[v]);
  }
}

std::optional<std::uint32_t> SurfaceTouch::target(const Vec3& centre, double radius) const {
  // Most poses are far away: decide from the bounding box, then from the vertices, and only then
  // from the triangles.
  const Vec3 outside = (low_.cast<double>() - centre).cwiseMax(centre - high_.cast<double>());
  if (vertices_.empty() || outside.maxCoeff() > radius) return std::nullopt;
  double nearest = std::numeric_limits<double>::infinity();
  std::uint32_t target = 0;
  for (const std::uint32_t v : vertices_) {
    const double squared = (body_->rest[v].cast<double>() - centre).squaredNorm();
    if (squared < nearest) {
      nearest = squared;
      target = v;
    }
  }
  nearest = std::sqrt(nearest);
  if (nearest <= radius) return target;
  if (nearest > radius + longest_edge_) return std::nullopt;
  for (const Triangle& triangle : body_->surface) {
    const auto corner = [&](int i) -> Vec3 { return body_->rest[triangle[i]].cast<double>(); };
    if (distance_to_triangle(centre, corner(0), corner(1), corner(2)) <= radius) return target;
  }
  return std::nullopt;
}

double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::array<double, 3> w = closest_in_triangle(p, a, b, c);
  return (p - w[0] * a - w[1] * b - w[2] * c).norm();
}

}  // namespace tissue
