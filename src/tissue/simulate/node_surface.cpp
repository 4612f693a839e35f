#include "node_surface.h"

#include "closest_points.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tissue {
namespace {

// The line from the nearest place of a triangle to the nearest place of a capsule's axis.
Vec3 apart(const std::array<Vec3, 3>& t, const Capsule& capsule) {
  const auto from = [&](const Vec3& place) -> Vec3 {
    const std::array<double, 3> w = closest_in_triangle(place, t[0], t[1], t[2]);
    return place - w[0] * t[0] - w[1] * t[1] - w[2] * t[2];
  };
  Vec3 nearest = from(capsule.tip);
  if (capsule.is_ball()) return nearest;
  const auto keep_nearer = [&](const Vec3& other) {
    if (other.squaredNorm() < nearest.squaredNorm()) nearest = other;
  };
  keep_nearer(from(capsule.end));
  const Vec3 axis = capsule.end - capsule.tip;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = t[k], &b = t[(k + 1) % 3];
    const AlongSegments along = closest_of_segments(capsule.tip, capsule.end, a, b);
    keep_nearer(capsule.tip + along.first * axis - a - along.second * (b - a));
  }
  // An axis may pierce a face and be far from its edges.
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double above = normal.dot(capsule.tip - t[0]), below = normal.dot(capsule.end - t[0]);
  if (above * below < 0.0) keep_nearer(from(capsule.tip + above / (above - below) * axis));
  return nearest;
}

bool is_beyond(const std::array<Vec3, 3>& t, const Vec3& low, const Vec3& high) {
  return (t[0].cwiseMax(t[1]).cwiseMax(t[2]).array() < low.array()).any() ||
         (t[0].cwiseMin(t[1]).cwiseMin(t[2]).array() > high.array()).any();
}

}  // namespace

bool faces(const std::array<Vec3, 3>& triangle, const Capsule& capsule) {
  const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  return normal.dot(capsule.tip - triangle[0]) > 0.0 || normal.dot(capsule.end - triangle[0]) > 0.0;
}

NodeSurface::NodeSurface(const FiniteElements& elements, const Body& body)
    : triangles(body.surface) {
  if (elements.order() == 2) {
    std::map<Edge, std::uint32_t> midpoint;
    for (std::uint32_t i = 0; i < elements.midpoints().size(); ++i) {
      const auto ends = std::minmax(elements.midpoints()[i][0], elements.midpoints()[i][1]);
      midpoint[{ends.first, ends.second}] = static_cast<std::uint32_t>(elements.vertex_count()) + i;
    }
    triangles.clear();
    for (const Triangle& corners : body.surface) {
      Triangle middles{};
      std::size_t found = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto ends = std::minmax(corners[(k + 1) % 3], corners[(k + 2) % 3]);
        const auto middle = midpoint.find({ends.first, ends.second});
        if (middle != midpoint.end()) middles[found++] = middle->second;
      }
      // A face of rigid tissue stays flat.
      if (found < 3) {
        triangles.push_back(corners);
        continue;
      }
      triangles.push_back(middles);
      for (std::size_t k = 0; k < 3; ++k) {
        triangles.push_back({corners[k], middles[(k + 2) % 3], middles[(k + 1) % 3]});
      }
    }
  }
  for (const Triangle& t : triangles) {
    const Vec3& origin = elements.rest()[t[0]];
    areas.push_back(0.5 *
                    (elements.rest()[t[1]] - origin).cross(elements.rest()[t[2]] - origin).norm());
  }
}

// A ray along x leaves the body once more than it enters it. Whether it passes an edge is decided
// for the edge, not for its triangles, so that it passes between no two of them.
bool NodeSurface::contains(const Vec3& place, const Eigen::VectorXd& positions) const {
  const auto is_left_of = [&](std::uint32_t a, std::uint32_t b) {
    const bool turned = a > b;
    if (turned) std::swap(a, b);
    const Vec3 from = node_at(positions, a) - place, to = node_at(positions, b) - place;
    double side = from.y() * to.z() - from.z() * to.y();
    // A ray that meets the edge is taken to be a little beside it (Edelsbrunner and Mücke,
    // Simulation of Simplicity, ACM TOG 9(1), 1990).
    if (side == 0.0) side = from.z() - to.z();
    if (side == 0.0) side = to.y() - from.y();
    return (side > 0.0) != turned;
  };
  int winding = 0;
  for (const Triangle& triangle : triangles) {
    const std::array<Vec3, 3> t = corners_of(triangle, positions);
    const Vec3 low = t[0].cwiseMin(t[1]).cwiseMin(t[2]), high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    if (high.x() < place.x() || low.y() > place.y() || high.y() < place.y() ||
        low.z() > place.z() || high.z() < place.z()) {
      continue;
    }
    const bool left = is_left_of(triangle[0], triangle[1]);
    if (left != is_left_of(triangle[1], triangle[2]) ||
        left != is_left_of(triangle[2], triangle[0])) {
      continue;
    }
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    if (normal.x() == 0.0 || normal.dot(t[0] - place) / normal.x() < 0.0) continue;
    winding += normal.x() > 0.0 ? 1 : -1;
  }
  return winding > 0;
}

double NodeSurface::distance(const Capsule& capsule, const Eigen::VectorXd& positions,
                             double limit) const {
  double nearest = limit;
  for (const Triangle& triangle : triangles) {
    const std::array<Vec3, 3> t = corners_of(triangle, positions);
    const Vec3 low = capsule.tip.cwiseMin(capsule.end).array() - nearest,
               high = capsule.tip.cwiseMax(capsule.end).array() + nearest;
    if (!is_beyond(t, low, high)) nearest = std::min(nearest, apart(t, capsule).norm());
  }
  return nearest;
}

double NodeSurface::free_way(const Capsule& from, const Capsule& to,
                             const Eigen::VectorXd& positions, double distance) const {
  const Vec3 low = from.tip.cwiseMin(from.end).cwiseMin(to.tip.cwiseMin(to.end)).array() - distance,
             high =
                 from.tip.cwiseMax(from.end).cwiseMax(to.tip.cwiseMax(to.end)).array() + distance;
  double part = 1.0;
  for (const Triangle& triangle : triangles) {
    const std::array<Vec3, 3> t = corners_of(triangle, positions);
    if (is_beyond(t, low, high) || !faces(t, from)) continue;
    // A plane between the two stays between them for so long.
    const Vec3 off = apart(t, from);
    const double away = off.norm();
    const double nearing =
        -std::min((to.tip - from.tip).dot(off), (to.end - from.end).dot(off)) / away;
    if (nearing > 0.0) part = std::min(part, std::max(away - distance, 0.0) / nearing);
  }
  return part;
}

}  // namespace tissue
