#pragma once

#include "effect_costs.h"
#include "tool_actions.h"
#include "tissue/simulate/damping.h"
#include "tissue/simulate/equilibrium.h"
#include "tissue/simulate/inertia.h"

namespace tissue {

/// Implicit Euler: what the effects `inertia` and `damping` make of a solid.
class Dynamics {
 public:
  /// References must outlive this.
  Dynamics(const SceneDescription& scene, const FiniteElements& elements, const Energy& tissue,
           EffectCosts& costs);

  /// What a step adds to the body's own energies.
  std::vector<const Energy*> energies() const;

  /// Advances by `dt` > 0 seconds, in substeps in which the tools go to where they are wished.
  /// Where a substep fails, everything is as before.
  EquilibriumReport advance(Equilibrium& equilibrium, ToolActions& actions, const ToolPoses& tools,
                            double dt, Eigen::VectorXd& positions);

  /// At rest.
  void reset();
  /// Of all nodes, three after three [m/s].
  const Eigen::VectorXd& velocities() const { return velocities_; }
  /// [J]
  double kinetic_energy() const;
  /// What the body's own energies came to at the end of the last step that did not fail [J].
  double potential_energy() const { return potential_energy_; }
  /// False once nothing has moved to speak of for some steps.
  bool moving() const { return quiet_steps_ < kQuietSteps; }

 private:
  static constexpr int kQuietSteps = 10;
  EquilibriumReport substep(Equilibrium& equilibrium, const ToolActions& actions,
                            const Eigen::VectorXd& motion, double h, Eigen::VectorXd& positions);
  void count_quiet_steps();

  EquilibriumOptions solver_;
  InertiaOptions options_;
  InertiaEnergy inertia_;
  std::optional<DampingEnergy> damping_;
  std::vector<CountedEnergy> counted_;
  EffectCost* inertia_cost_;
  EffectCost* damping_cost_;
  Eigen::VectorXd velocities_;
  // Size of the body [m].
  double extent_;
  double last_h_ = 0.0, potential_energy_ = 0.0;
  int quiet_steps_ = 0;
};

}  // namespace tissue
