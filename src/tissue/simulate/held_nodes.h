#pragma once

#include "grip.h"
#include "tissue/simulate/finite_elements.h"

#include <functional>

namespace tissue {

/// The nodes of a solid that do not move by themselves: vertices that anchors or tools hold, and
/// the midpoints between two such; of two that a patch holds, only those on the surface.
class HeldNodes {
 public:
  /// References must outlive this. `anchor_of_vertex` as anchors_of_vertices() gives it.
  HeldNodes(const FiniteElements& elements, const Body& body,
            const std::vector<ToolDescription>& tools, std::size_t anchor_count,
            std::vector<int> anchor_of_vertex);

  /// Tools take hold or let go. True if that changed what is held.
  bool update(const ToolPoses& tools, const std::vector<Vec3>& vertices_now);
  /// Tools hold nothing.
  void release();
  bool any_grip() const;

  /// For each node whether it is held.
  std::vector<std::uint8_t> flags() const;
  /// The motion of held nodes from `positions` to where the tools take them, and of midpoints
  /// that no tool holds itself to half-way between their ends.
  Eigen::VectorXd motion_to(const ToolPoses& tools, const Eigen::VectorXd& positions) const;
  /// The motion of what a tool at `pose` holds if the places that it carries move as `motion_at`
  /// says for their offset from its centre.
  Eigen::VectorXd motion_of(std::size_t tool, const ToolPose& pose, Eigen::Index coordinates,
                            const std::function<Vec3(const Vec3&)>& motion_at) const;
  /// Puts the vertices that tools hold exactly where they belong.
  void place(const ToolPoses& tools, std::vector<Vec3>& vertices) const;

  /// The tissue's force on each holder [N], anchors first, then tools: minus dE along its motion.
  /// What a patch's rim does not give to its tool, nobody bears.
  std::vector<Vec3> forces(const Eigen::VectorXd& gradient) const;

 private:
  void find_holders();
  void take_midpoints(std::size_t tool, const ToolPose& pose,
                      const std::vector<Vec3>& vertices_now);

  const FiniteElements& elements_;
  const std::vector<ToolDescription>& tools_;
  std::vector<Grip> grips_;
  std::size_t anchor_count_;
  // Who holds each vertex: an anchor; an anchor or (counted on) a tool.
  std::vector<int> anchor_of_vertex_, holders_;
  // Midpoints, counted from 0, that are held half-way between their ends.
  std::vector<std::size_t> halfway_;
  // A flag for each vertex and midpoint; empty where no tool asks.
  std::vector<std::uint8_t> on_surface_;
};

}  // namespace tissue
