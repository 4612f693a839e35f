#pragma once

#include "jaw.h"
#include "surface_springs.h"
#include "tissue/simulate/anchors.h"

namespace tissue {

/// What holds a body softly: anchors that are beds, and tools that move the surface through pads,
/// stiffest in the middle and fading out towards the rim. Anchors are the first holders, then
/// tools.
class SoftHolds {
 public:
  /// References must outlive this.
  SoftHolds(const SceneDescription& scene, const FiniteElements& elements, const Body& body);
  /// Whether the scene has any.
  static bool are_in(const SceneDescription& scene);

  /// Tools take hold of the surface as it is, or let go. True if that changed anything.
  bool update(const ToolPoses& tools, const Eigen::VectorXd& positions);
  /// Tools hold nothing.
  void release();
  bool any_pad() const;
  bool holds(std::size_t tool) const { return springs_.is_attached(first_tool_ + tool); }

  /// How far the ends of all springs are from where the tools take them, three after three; what no
  /// tool with a pose holds stays.
  Eigen::VectorXd motion_to(const ToolPoses& tools) const;
  void move(const Eigen::VectorXd& motion) { springs_.move(motion); }

  const Energy& energy() const { return springs_; }
  /// Of the tissue on a tool.
  Wrench wrench(std::size_t tool, const Eigen::VectorXd& positions, const Vec3& centre) const;
  /// Adds how dE/dx changes for each metre by which a tool moves along `direction`.
  void add_pull(std::size_t tool, const Vec3& direction, Eigen::VectorXd& gradient) const;
  /// How the force on a tool changes where that moves by `direction` and the nodes by `response`.
  Vec3 force_change(std::size_t tool, const Vec3& direction, const Eigen::VectorXd& response) const;
  /// Adds the tissue's force on each holder [N].
  void add_forces(const Eigen::VectorXd& positions, std::vector<Vec3>& forces) const;

 private:
  struct Pad {
    Jaw jaw;
    // Of the springs' ends, from the tool's centre in its frame [m].
    std::vector<Vec3> offsets;
  };
  const std::vector<ToolDescription>& tools_;
  std::size_t first_tool_;
  SurfaceSprings springs_;
  std::vector<Pad> pads_;
};

}  // namespace tissue
