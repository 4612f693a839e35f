#pragma once

#include "grip.h"
#include "tissue/simulate/finite_elements.h"

#include <functional>

namespace tissue {

/// The nodes of a solid that do not move by themselves: vertices that anchors or tools hold, and
/// the midpoints between two such.
class HeldNodes {
 public:
  /// References must outlive this. `anchor_of_vertex` as anchors_of_vertices() gives it. Who holds
  /// some of an inclusion's vertices holds all of them.
  HeldNodes(const FiniteElements& elements, const std::vector<ToolDescription>& tools,
            std::size_t anchor_count, std::vector<int> anchor_of_vertex,
            const std::vector<std::vector<std::uint32_t>>& inclusions = {});

  /// Tools take hold or let go. True if that changed what is held.
  bool update(const ToolPoses& tools, const std::vector<Vec3>& vertices_now);
  /// Tools hold nothing.
  void release();
  bool any_grip() const;
  bool holds(std::size_t tool) const { return !grips_[tool].vertices().empty(); }

  /// For each node whether it is held.
  std::vector<std::uint8_t> flags() const;
  /// The motion of held nodes from `positions` to where the tools take them: vertices as parts of
  /// the tool, midpoints half-way between their ends.
  Eigen::VectorXd motion_to(const ToolPoses& tools, const Eigen::VectorXd& positions) const;
  /// The motion of what a tool holds, as `motion_at` says for an offset from `centre`.
  Eigen::VectorXd motion_of(std::size_t tool, const Eigen::VectorXd& positions, const Vec3& centre,
                            const std::function<Vec3(const Vec3&)>& motion_at) const;
  /// Puts the vertices that tools hold exactly where they belong.
  void place(const ToolPoses& tools, std::vector<Vec3>& vertices) const;

  /// A node that a tool holds, wholly or together with another holder.
  struct Share {
    std::size_t node;
    double part;
  };
  std::vector<Share> shares(std::size_t tool) const;
  /// Minus the sum of dE/dx over what each holder holds, anchors first, then tools: the tissue's
  /// force on it [N].
  std::vector<Vec3> forces(const Eigen::VectorXd& gradient) const;
  /// The same for one tool, with its torque about `centre`, where the nodes are at `positions`.
  Wrench wrench(std::size_t tool, const Eigen::VectorXd& gradient, const Eigen::VectorXd& positions,
                const Vec3& centre) const;

 private:
  bool is_held_midpoint(std::size_t midpoint) const;
  void find_holders();
  void complete_anchors(const std::vector<std::vector<std::uint32_t>>& inclusions);

  const FiniteElements& elements_;
  const std::vector<ToolDescription>& tools_;
  std::vector<Grip> grips_;
  std::size_t anchor_count_;
  // Of each vertex, or nobody's; empty without inclusions.
  std::vector<int> inclusion_of_;
  // Who holds each vertex: an anchor; an anchor or (counted on) a tool.
  std::vector<int> anchor_of_vertex_, holders_;
};

}  // namespace tissue
