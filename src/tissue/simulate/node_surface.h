#pragma once

#include "capsule.h"
#include "tissue/simulate/finite_elements.h"

namespace tissue {

/// The surface of a body in linear triangles over all nodes: of quadratic elements each triangle is
/// cut into four by the midpoints of its edges. Questions are about where the nodes are now.
struct NodeSurface {
  NodeSurface(const FiniteElements& elements, const Body& body);

  std::vector<Triangle> triangles;
  /// At rest [m²].
  std::vector<double> areas;

  /// Whether a place lies inside.
  bool contains(const Vec3& place, const Eigen::VectorXd& positions) const;
  /// How far the axis of a capsule is from the surface, if that is less than `limit` [m].
  double distance(const Capsule& capsule, const Eigen::VectorXd& positions, double limit) const;
  /// How much of the way from one capsule to another it may go, from 0 to 1, before its axis comes
  /// nearer than `distance` to a triangle that faces it.
  double free_way(const Capsule& from, const Capsule& to, const Eigen::VectorXd& positions,
                  double distance) const;
};

/// Whether some of a capsule's axis is on the outer side of a triangle.
bool faces(const std::array<Vec3, 3>& triangle, const Capsule& capsule);

inline Vec3 node_at(const Eigen::VectorXd& positions, std::uint32_t node) {
  return positions.segment<3>(3 * Eigen::Index{node});
}
inline std::array<Vec3, 3> corners_of(const Triangle& triangle, const Eigen::VectorXd& positions) {
  return {node_at(positions, triangle[0]), node_at(positions, triangle[1]),
          node_at(positions, triangle[2])};
}

}  // namespace tissue
