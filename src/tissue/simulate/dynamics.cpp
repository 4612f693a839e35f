#include "dynamics.h"

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

// A longer step than these many substeps is cut into as many, longer ones: implicit Euler stays
// stable, and what is lost is detail of the motion in between.
constexpr int kMaxSubsteps = 100;

}  // namespace

Dynamics::Dynamics(const SceneDescription& scene, const FiniteElements& elements,
                   const Energy& tissue, EffectCosts& costs)
    : solver_(scene.solver),
      options_(*scene.find<InertiaOptions>()),
      inertia_(elements, scene.material.mass_density),
      inertia_cost_(costs.of<InertiaOptions>()),
      damping_cost_(costs.of<DampingOptions>()),
      velocities_(Eigen::VectorXd::Zero(rest_positions(elements).size())) {
  Eigen::AlignedBox3d box;
  for (const Vec3& place : elements.rest()) box.extend(place);
  extent_ = box.diagonal().norm();
  counted_.emplace_back(inertia_, inertia_cost_);
  inertia_cost_->bytes = inertia_.bytes() + velocities_.size() * sizeof(double);
  if (damping_cost_ == nullptr) return;
  const DampingOptions& damping = *scene.find<DampingOptions>();
  damping_.emplace(tissue, elements, inertia_.mass(), damping.mass, damping.stiffness);
  counted_.emplace_back(*damping_, damping_cost_);
  damping_cost_->bytes = damping_->bytes() + velocities_.size() * sizeof(double);
}

std::vector<const Energy*> Dynamics::energies() const {
  std::vector<const Energy*> result;
  for (const CountedEnergy& energy : counted_) result.push_back(&energy);
  return result;
}

void Dynamics::reset() {
  velocities_.setZero();
  quiet_steps_ = 0;
}

double Dynamics::kinetic_energy() const {
  return 0.5 * velocities_.dot(inertia_.mass().times(velocities_));
}

EquilibriumReport Dynamics::advance(Equilibrium& equilibrium, ToolActions& actions,
                                    const ToolPoses& tools, double dt, Eigen::VectorXd& positions) {
  const double wished = std::min(std::ceil(dt / options_.substep), 1e6),
               strides = 1.0 / std::max(actions.stride(tools, positions), 1.0 / kMaxStrides);
  const int substeps =
      std::clamp(static_cast<int>(std::ceil(std::max(wished, strides))), 1, kMaxSubsteps);
  const Eigen::VectorXd positions_before = positions, velocities_before = velocities_;
  const ToolPoses tools_before = actions.reached();
  EquilibriumReport report;
  report.converged = true;
  for (int done = 0; done < substeps && report.converged; ++done) {
    const double part = std::min(1.0 / (substeps - done), actions.stride(tools, positions));
    const Eigen::VectorXd motion =
        actions.follow(between(actions.reached(), tools, part), positions);
    const EquilibriumReport one = substep(equilibrium, actions, motion, dt / substeps, positions);
    report.converged = one.converged && actions.accepts(positions);
    report.iterations += one.iterations;
    report.residual = std::max(report.residual, one.residual);
  }
  // A tool that moved in no time, for one, leaves velocities that no later step can do with.
  report.converged = report.converged && std::isfinite(potential_energy() + kinetic_energy());
  if (!report.converged) {
    positions = positions_before;
    velocities_ = velocities_before;
    actions.follow(tools_before, positions);
  }
  count_quiet_steps();
  return report;
}

EquilibriumReport Dynamics::substep(Equilibrium& equilibrium, const ToolActions& actions,
                                    const Eigen::VectorXd& motion, double h,
                                    Eigen::VectorXd& positions) {
  const Eigen::VectorXd start = positions;
  {
    const CostClock clock(inertia_cost_);
    inertia_.begin_step(start, velocities_, h);
  }
  if (damping_) {
    const CostClock clock(damping_cost_);
    damping_->begin_step(start, h);
  }
  if (h != last_h_) equilibrium.forget_hessian();
  last_h_ = h;
  EquilibriumReport report = equilibrium.linearised_step(positions, motion);
  EquilibriumOptions options = solver_;
  if (!actions.is_stiff()) options.max_iterations = options_.iterations - 1;
  // A step that goes too far is found by line searches instead.
  if (!report.converged) {
    positions = start + motion;
    options.max_iterations = solver_.max_iterations;
  }
  if (options.max_iterations > 0) {
    int iterations = report.iterations;
    do {
      report = equilibrium.solve(positions, options);
      iterations += report.iterations;
    } while (report.converged && actions.refine(positions));
    report.iterations = iterations;
  }
  if (report.converged) {
    velocities_ = (positions - start) / h;
    potential_energy_ = report.energy;
    for (const CountedEnergy& energy : counted_) potential_energy_ -= energy.value(positions);
  }
  return report;
}

void Dynamics::count_quiet_steps() {
  // Nothing that would show: a body that moves by less than this part of its size in a second.
  constexpr double kSlow = 1e-5;
  const double fastest = velocities_.cwiseAbs().maxCoeff();
  quiet_steps_ = fastest < kSlow * extent_ ? quiet_steps_ + 1 : 0;
}

}  // namespace tissue
