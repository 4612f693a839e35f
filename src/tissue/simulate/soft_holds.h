#pragma once

#include "jaw.h"
#include "solid_effect.h"
#include "surface_springs.h"
#include "tissue/simulate/anchors.h"

namespace tissue {

/// What holds a body softly: anchors that are beds, and tools that move the surface through pads,
/// stiffest in the middle and fading out towards the rim. Anchors are the first holders, then
/// tools.
class SoftHolds : public SolidEffect, public ToolLink {
 public:
  /// References must outlive this.
  SoftHolds(const SceneDescription& scene, const FiniteElements& elements, const Body& body);
  /// Whether the scene has any.
  static bool are_in(const SceneDescription& scene);

  const Energy* energy() const override { return &springs_; }
  bool loads() const override { return false; }
  const ToolLink* link() const override { return this; }
  bool any_pad() const;

  bool take(const ToolPoses& tools, const PositionsNow& positions_now) override;
  bool follow(const ToolPoses& tools, const Eigen::VectorXd& positions) override;
  /// Tools hold nothing.
  void reset() override;

  bool acts_on(std::size_t tool) const override { return springs_.is_attached(first_tool_ + tool); }
  Wrench wrench(std::size_t tool, const Eigen::VectorXd& positions,
                const Vec3& centre) const override;
  void add_pull(std::size_t tool, const Eigen::VectorXd& positions, const Vec3& direction,
                Eigen::VectorXd& gradient) const override;
  Vec3 force_change(std::size_t tool, const Eigen::VectorXd& positions, const Vec3& direction,
                    const Eigen::VectorXd& response) const override;
  /// Adds the tissue's force on each anchor [N].
  void add_anchor_forces(const Eigen::VectorXd& positions, std::vector<Vec3>& forces) const;

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
