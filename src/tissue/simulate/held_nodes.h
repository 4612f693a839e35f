#pragma once

#include "grip.h"
#include "tissue/simulate/finite_elements.h"

#include <functional>

namespace tissue {

/// The nodes of a solid that do not move by themselves: vertices that anchors or tools hold, and
/// the midpoints between two such.
class HeldNodes {
 public:
  /// References must outlive this. `anchored` has a flag for each vertex.
  HeldNodes(const FiniteElements& elements, const std::vector<ToolDescription>& tools,
            std::vector<std::uint8_t> anchored);

  /// Tools take hold or let go. True if that changed what is held.
  bool update(const ToolPoses& tools, const std::vector<Vec3>& vertices_now);
  /// Tools hold nothing.
  void release();
  bool any_grip() const;

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

  /// Minus the sum of dE/dx over what a tool, or all anchors, hold: the tissue's force on it [N].
  Vec3 force_on_tool(std::size_t tool, const Eigen::VectorXd& gradient) const;
  Vec3 force_on_anchors(const Eigen::VectorXd& gradient) const;

 private:
  bool is_held_midpoint(std::size_t midpoint) const;
  void find_taken();
  Vec3 force_on(const std::vector<std::uint8_t>& vertices, const Eigen::VectorXd& gradient) const;

  const FiniteElements& elements_;
  const std::vector<ToolDescription>& tools_;
  std::vector<Grip> grips_;
  // For each vertex whether an anchor holds it; whether an anchor or a tool does.
  std::vector<std::uint8_t> anchored_, taken_;
};

}  // namespace tissue
