#pragma once

#include "effect_costs.h"
#include "held_nodes.h"
#include "soft_holds.h"
#include "solid_effect.h"

namespace tissue {

/// Tools that may not go all their way at once come to so many places in a step, at most.
constexpr int kMaxStrides = 16;

/// All that tools do to a solid: the nodes that they hold, and what effects make of their motion.
/// Knows how far they have come.
class ToolActions {
 public:
  struct Part {
    SolidEffect* effect;
    EffectCost* cost;
  };
  /// References must outlive this.
  ToolActions(const std::vector<ToolDescription>& tools, HeldNodes& held, std::vector<Part> parts);

  /// Tools take hold or let go. True if that changes forces, `regrips()` if it changes which nodes
  /// are held.
  bool take(const ToolPoses& tools, const std::vector<Vec3>& vertices,
            const PositionsNow& positions);
  bool regrips() const { return regrips_; }
  void release();

  /// How much of what is left of the way to `tools` they may go at once.
  double stride(const ToolPoses& tools, const Eigen::VectorXd& positions) const;
  /// They go there, and what they hold is to move by what this returns.
  Eigen::VectorXd follow(const ToolPoses& tools, const Eigen::VectorXd& positions);
  /// Whether the last follow() changed forces besides.
  bool changed() const { return changed_; }
  /// Where they are.
  const ToolPoses& reached() const { return reached_; }
  void set_reached(const ToolPoses& tools) { reached_ = tools; }

  bool is_stiff() const;
  bool refine(const Eigen::VectorXd& positions) const;
  bool accepts(const Eigen::VectorXd& positions) const;

 private:
  const std::vector<ToolDescription>& tools_;
  HeldNodes& held_;
  std::vector<Part> parts_;
  ToolPoses reached_;
  bool regrips_ = false, changed_ = false;
};

/// Part of the way from each pose to the next; where a tool has no pose before, it is there at
/// once.
ToolPoses between(const ToolPoses& from, const ToolPoses& to, double part);

}  // namespace tissue
