#pragma once

#include "effect_costs.h"
#include "held_nodes.h"
#include "soft_holds.h"
#include "tissue/simulate/equilibrium.h"

namespace tissue {

/// What tools feel: force and torque from the solver's own residual at what they hold, and how that
/// changes as they move, by the Hessian at hand.
class ForceFeedback {
 public:
  /// References must outlive this; `soft` may be nothing.
  ForceFeedback(const HeldNodes& held, const SoftHolds* soft, Equilibrium& equilibrium,
                EffectCost* cost);

  /// To be called after a step. Where `keep_compliance` is set and a tool has one, that stays:
  /// small strain does not change it while the same nodes are held.
  void update(const ToolPoses& tools, const Eigen::VectorXd& positions, bool keep_compliance);
  /// Nothing for a tool that holds nothing.
  const std::vector<std::optional<ToolFeedback>>& tools() const { return tools_; }
  void reset() { tools_.clear(); }

 private:
  Mat3 compliance_of(std::size_t tool, const ToolPose& pose, const Eigen::VectorXd& positions);

  const HeldNodes& held_;
  const SoftHolds* soft_;
  Equilibrium& equilibrium_;
  EffectCost* cost_;
  std::vector<std::optional<ToolFeedback>> tools_;
};

}  // namespace tissue
