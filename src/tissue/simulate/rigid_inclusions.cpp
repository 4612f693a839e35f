#include "rigid_inclusions.h"

#include "tissue/base/disjoint_sets.h"
#include "tissue/base/error.h"
#include "tissue/base/tet_shape.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <set>

namespace tissue {

using Six = Eigen::Matrix<double, 6, 1>;

RigidInclusions::RigidInclusions(const Body& body, double density_above) {
  if (body.tet_densities.empty()) {
    throw InputError(ErrorCode::kParam,
                     "rigid_inclusions: the mesh does not say the densities of its tets");
  }
  DisjointSets sets(body.rest.size());
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    if (!(body.tet_densities[t] > density_above)) continue;
    tets.push_back(body.tets[t]);
    tet_numbers.push_back(static_cast<std::uint32_t>(t));
    for (const std::uint32_t v : body.tets[t]) sets.unite(body.tets[t][0], v);
  }
  if (tets.size() == body.tets.size()) {
    throw InputError(ErrorCode::kParam, "rigid_inclusions: density_above " +
                                            to_text(density_above) +
                                            " leaves nothing of the body to deform");
  }
  std::vector<std::uint8_t> is_rigid(body.rest.size(), 0);
  for (const Tet& tet : tets) {
    for (const std::uint32_t v : tet) is_rigid[v] = 1;
  }
  std::vector<std::size_t> number(body.rest.size(), 0);
  for (std::uint32_t v = 0; v < is_rigid.size(); ++v) {
    if (is_rigid[v] == 0) continue;
    const std::uint32_t first = sets.find(v);
    if (first == v) {
      number[v] = vertices.size();
      vertices.emplace_back();
    }
    vertices[number[first]].push_back(v);
  }
}

Body RigidInclusions::soft_part(const Body& body) const {
  Body soft = body;
  soft.tets.clear();
  soft.tet_densities.clear();
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    if (!element_of(t)) continue;
    soft.tets.push_back(body.tets[t]);
    soft.tet_densities.push_back(body.tet_densities[t]);
  }
  return soft;
}

std::size_t RigidInclusions::bytes() const {
  std::size_t sum = tets.capacity() * sizeof(Tet) + tet_numbers.capacity() * sizeof(std::uint32_t);
  for (const auto& nodes : vertices) sum += nodes.capacity() * sizeof(std::uint32_t);
  return sum;
}

std::optional<std::size_t> RigidInclusions::element_of(std::size_t tet) const {
  const auto at = std::lower_bound(tet_numbers.begin(), tet_numbers.end(), tet);
  if (at != tet_numbers.end() && *at == tet) return std::nullopt;
  return tet - static_cast<std::size_t>(at - tet_numbers.begin());
}

RigidMotions::RigidMotions(const RigidInclusions& inclusions, const FiniteElements& elements,
                           bool small_strain, EffectCost& cost)
    : small_strain_(small_strain), cost_(cost) {
  const CostClock clock(&cost_);
  std::vector<int> group_of(elements.vertex_count(), -1);
  // A midpoint is rigid if its edge is, not if only both its ends are.
  std::set<Edge> edges;
  for (const Tet& tet : inclusions.tets) {
    for (const auto& [a, b] : kTetEdges) {
      edges.insert({std::min(tet[a], tet[b]), std::max(tet[a], tet[b])});
    }
  }
  for (const std::vector<std::uint32_t>& nodes : inclusions.vertices) {
    for (const std::uint32_t v : nodes) group_of[v] = static_cast<int>(groups_.size());
    groups_.emplace_back().nodes = nodes;
  }
  for (std::size_t i = 0; i < elements.midpoints().size(); ++i) {
    const auto [a, b] = elements.midpoints()[i];
    if (edges.count({std::min(a, b), std::max(a, b)}) == 0) continue;
    groups_[static_cast<std::size_t>(group_of[a])].nodes.push_back(
        static_cast<std::uint32_t>(elements.vertex_count() + i));
  }
  positions_ = rest_positions(elements);
  cost_.bytes += static_cast<std::size_t>(positions_.size()) * sizeof(double);
  for (const Group& group : groups_) {
    cost_.bytes += sizeof(Group) + group.nodes.capacity() * sizeof(std::uint32_t);
  }
  find_products();
}

void RigidMotions::hold(const std::vector<std::uint8_t>& fixed) {
  for (Group& group : groups_) group.is_held = fixed[3 * std::size_t{group.nodes.front()}] != 0;
}

void RigidMotions::look_at(const Eigen::VectorXd& positions) {
  // Small strain has the same motions everywhere.
  if (small_strain_) return;
  const CostClock clock(&cost_);
  positions_ = positions;
  find_products();
}

void RigidMotions::find_products() {
  for (Group& group : groups_) {
    const auto count = static_cast<double>(group.nodes.size());
    group.centre.setZero();
    for (const std::uint32_t i : group.nodes) {
      group.centre += positions_.segment<3>(3 * Eigen::Index{i}) / count;
    }
    double squares = 0.0;
    for (const std::uint32_t i : group.nodes) {
      squares += (positions_.segment<3>(3 * Eigen::Index{i}) - group.centre).squaredNorm();
    }
    group.size = std::sqrt(squares / count);
    group.products.setZero();
    for (const std::uint32_t i : group.nodes) {
      const Vec3 r = offset(group, i);
      group.products.topLeftCorner<3, 3>() += Mat3::Identity();
      group.products.bottomRightCorner<3, 3>() +=
          r.squaredNorm() * Mat3::Identity() - r * r.transpose();
    }
  }
}

Six RigidMotions::moments(const Group& group, const Eigen::VectorXd& forces) const {
  Six sum = Six::Zero();
  for (const std::uint32_t i : group.nodes) {
    const Vec3 force = forces.segment<3>(3 * Eigen::Index{i});
    sum.head<3>() += force;
    sum.tail<3>() += offset(group, i).cross(force);
  }
  return sum;
}

void RigidMotions::add_motion(const Group& group, const Six& amounts,
                              Eigen::VectorXd& motion) const {
  for (const std::uint32_t i : group.nodes) {
    motion.segment<3>(3 * Eigen::Index{i}) +=
        amounts.head<3>() + Vec3(amounts.tail<3>()).cross(offset(group, i));
  }
}

// Of the nearest one.
Six RigidMotions::amounts(const Group& group, const Eigen::VectorXd& motion) const {
  return group.products.ldlt().solve(moments(group, motion));
}

void RigidMotions::project(Eigen::VectorXd& motion) const {
  const CostClock clock(&cost_);
  for (const Group& group : groups_) {
    if (group.is_held) continue;
    const Six nearest = amounts(group, motion);
    for (const std::uint32_t i : group.nodes) motion.segment<3>(3 * Eigen::Index{i}).setZero();
    add_motion(group, nearest, motion);
  }
}

Eigen::VectorXd RigidMotions::moved(const Eigen::VectorXd& positions,
                                    const Eigen::VectorXd& motion) const {
  Eigen::VectorXd result = positions + motion;
  if (small_strain_) return result;
  const CostClock clock(&cost_);
  for (const Group& group : groups_) {
    if (group.is_held) continue;
    const Six nearest = amounts(group, motion);
    const Vec3 turn = nearest.tail<3>() / group.size;
    const double angle = turn.norm();
    const Mat3 rotation = angle > 0.0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix()
                                      : Mat3(Mat3::Identity());
    for (const std::uint32_t i : group.nodes) {
      const auto at = 3 * Eigen::Index{i};
      const Vec3 arm = positions.segment<3>(at) - group.centre;
      result.segment<3>(at) = group.centre + nearest.head<3>() + rotation * arm;
    }
  }
  return result;
}

}  // namespace tissue
