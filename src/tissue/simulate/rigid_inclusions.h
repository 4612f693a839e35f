#pragma once

#include "effect_costs.h"
#include "tissue/simulate/body.h"
#include "tissue/simulate/finite_elements.h"

#include <Eigen/Core>

#include <optional>

namespace tissue {

/// Connected tissue that moves as rigid bodies.
struct RigidInclusions {
  /// Tets denser than a value; connected where they share a vertex. Throws InputError E_PARAM if
  /// that is all of the body, or the body does not say its tets' densities.
  RigidInclusions(const Body& body, double density_above);
  RigidInclusions() = default;

  bool empty() const { return vertices.empty(); }
  std::size_t bytes() const;
  /// The body without their tets; its vertices stay.
  Body soft_part(const Body& body) const;

  /// The number of a tet in the soft part; nothing for one of an inclusion.
  std::optional<std::size_t> element_of(std::size_t tet) const;

  std::vector<Tet> tets;
  /// Of those, in the body.
  std::vector<std::uint32_t> tet_numbers;
  /// Of each inclusion.
  std::vector<std::vector<std::uint32_t>> vertices;
};

/// The motions that rigid inclusions leave to a body: six of each, and those of all other nodes.
class RigidMotions {
 public:
  /// `small_strain`: turns are added up as if they were infinitely small. What is done here is
  /// counted as `cost`, which must outlive this.
  RigidMotions(const RigidInclusions& inclusions, const FiniteElements& elements, bool small_strain,
               EffectCost& cost);

  struct Group {
    std::vector<std::uint32_t> nodes;
    Vec3 centre = Vec3::Zero();
    /// Root mean square of the distances from it [m].
    double size = 1.0;
    /// Of the six motions with each other.
    Eigen::Matrix<double, 6, 6> products;
    bool is_held = false;
  };
  const std::vector<Group>& groups() const { return groups_; }
  EffectCost& cost() const { return cost_; }

  /// Those of which all is held take no part.
  void hold(const std::vector<std::uint8_t>& fixed_coordinates);
  /// To be called before the rest, which is about motions from here.
  void look_at(const Eigen::VectorXd& positions);

  /// The nearest motion that is left.
  void project(Eigen::VectorXd& motion) const;
  /// How much of each of a group's motions is in forces on its nodes, or what the nodes do in such
  /// a motion.
  Eigen::Matrix<double, 6, 1> moments(const Group& group, const Eigen::VectorXd& forces) const;
  void add_motion(const Group& group, const Eigen::Matrix<double, 6, 1>& amounts,
                  Eigen::VectorXd& motion) const;
  /// Where a motion leads: inclusions keep their shape.
  Eigen::VectorXd moved(const Eigen::VectorXd& positions, const Eigen::VectorXd& motion) const;

 private:
  Eigen::Matrix<double, 6, 1> amounts(const Group& group, const Eigen::VectorXd& motion) const;
  void find_products();
  Vec3 offset(const Group& group, std::uint32_t node) const {
    return (positions_.segment<3>(3 * Eigen::Index{node}) - group.centre) / group.size;
  }

  std::vector<Group> groups_;
  bool small_strain_;
  EffectCost& cost_;
  Eigen::VectorXd positions_;
};

}  // namespace tissue
