#pragma once

#include "node_surface.h"
#include "tissue/simulate/energy.h"

#include <array>
#include <optional>

namespace tissue {

/// What keeps the surface out of balls and capsules, without friction: the square of how deep a
/// tool's nearest place on each triangle (and of a capsule's axis on each edge) lies in it, times a
/// stiffness that follows from the tissue's own. Faces count, not only vertices, so that tools may
/// be smaller than triangles.
///
/// Implicit: part of the energy that is minimised, so its stiffness limits no time step. What it
/// gives way by is a part of the tool's radius that hardly depends on the mesh.
class ContactEnergy : public Energy {
 public:
  /// `young` of each tet [Pa], `radii` of the tools [m]; `elements` must outlive this.
  ContactEnergy(const FiniteElements& elements, const Body& body, const std::vector<double>& young,
                const std::vector<double>& radii);

  const NodeSurface& surface() const { return surface_; }

  /// Puts a tool there, or takes it away. It may be thinner than it is in the end.
  void place(std::size_t tool, const std::optional<Capsule>& capsule);
  const std::optional<Capsule>& capsule(std::size_t tool) const { return tools_[tool].capsule; }

  /// Finds what of the surface, facing a tool, is nearer to it than `reach` of its radius: nothing
  /// else is looked at until this is called again.
  void find_pairs(const Eigen::VectorXd& positions, double reach);
  bool finds_nothing() const { return pairs_.empty(); }
  /// How deep the surface that was found lies in a tool, at most [m]; negative where it does not
  /// touch, minus infinity where nothing was found.
  double depth(std::size_t tool, const Eigen::VectorXd& positions) const;
  /// Makes it more difficult to enter a tool.
  void stiffen(std::size_t tool, double factor) { tools_[tool].stiffening *= factor; }
  /// As it was at first.
  void soften(std::size_t tool) { tools_[tool].stiffening = 1.0; }

  double evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                  Hessian* hessian) const override;
  bool is_penalty() const override { return true; }

  /// Calls body(offset, force) for each place where the tissue touches a tool: from `centre` [m],
  /// and of the tissue on the tool [N].
  template <class Body>
  void for_each_touch(std::size_t tool, const Eigen::VectorXd& positions, const Vec3& centre,
                      const Body& body) const;
  /// Adds how dE/dx changes for each metre by which a tool moves along `direction`.
  void add_pull(std::size_t tool, const Eigen::VectorXd& positions, const Vec3& direction,
                Eigen::VectorXd& gradient) const;
  /// How the force on a tool changes where that moves by `direction` and the nodes by `response`.
  Vec3 force_change(std::size_t tool, const Eigen::VectorXd& positions, const Vec3& direction,
                    const Eigen::VectorXd& response) const;

  std::size_t bytes() const;

 private:
  // A triangle, or an edge, and the part of a tool's axis that is looked at.
  enum class Part : std::uint8_t { kTip, kEnd, kAxis };
  struct Pair {
    std::uint32_t tool;
    Part part;
    // Two of them for an edge, the last repeated.
    std::array<std::uint32_t, 3> nodes;
    // [N/m], for a tool of radius 1 m.
    double stiffness;
  };
  struct Tool {
    double radius;
    std::optional<Capsule> capsule = {};
    double stiffening = 1.0;
  };
  struct Edges {
    Edge nodes;
    std::array<std::uint32_t, 2> triangles;
    double stiffness;
  };
  // Where a pair is nearest: weights of its nodes, the place on the axis and from there.
  struct Nearest {
    std::array<double, 3> weights;
    Vec3 on_axis, off;
    double distance;
    Vec3 direction() const { return distance > 0.0 ? Vec3(off / distance) : Vec3(Vec3::Zero()); }
  };
  Nearest nearest(const Pair& pair, const Eigen::VectorXd& positions, const Capsule& capsule) const;
  Nearest nearest(const Pair& pair, const Eigen::VectorXd& positions) const {
    return nearest(pair, positions, *tools_[pair.tool].capsule);
  }
  // Calls add(pair, nearest, force) so that the forces add up to how they change where the tool
  // moves by `direction` and the nodes by `response`, or stay if that is empty.
  template <class Add>
  void for_each_change(std::size_t tool, const Eigen::VectorXd& positions, const Vec3& direction,
                       const Eigen::VectorXd& response, const Add& add) const;
  std::array<Vec3, 3> weight_slopes(const Pair& pair, const Nearest& at,
                                    const Eigen::VectorXd& positions) const;
  double stiffness(const Pair& pair) const {
    const Tool& tool = tools_[pair.tool];
    return tool.stiffening * pair.stiffness / tool.radius;
  }

  NodeSurface surface_;
  // Young's modulus times area, times a factor [N].
  std::vector<double> triangle_stiffness_;
  std::vector<Edges> edges_;
  std::vector<Tool> tools_;
  std::vector<Pair> pairs_;
};

template <class Body>
void ContactEnergy::for_each_touch(std::size_t tool, const Eigen::VectorXd& positions,
                                   const Vec3& centre, const Body& body) const {
  for (const Pair& pair : pairs_) {
    if (pair.tool != tool) continue;
    const Nearest at = nearest(pair, positions);
    const double deep = tools_[tool].capsule->radius - at.distance;
    if (deep > 0.0)
      body(Vec3(at.on_axis + at.off - centre), Vec3(-stiffness(pair) * deep * at.direction()));
  }
}

}  // namespace tissue
