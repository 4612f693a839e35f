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
    : scene_(scene),
      inertia_(elements, scene.material.mass_density),
      inertia_cost_(costs.of(Effect::kInertia)),
      damping_cost_(costs.of(Effect::kDamping)),
      velocities_(Eigen::VectorXd::Zero(rest_positions(elements).size())) {
  Eigen::AlignedBox3d box;
  for (const Vec3& place : elements.rest()) box.extend(place);
  extent_ = box.diagonal().norm();
  counted_.emplace_back(inertia_, inertia_cost_);
  inertia_cost_->bytes = inertia_.bytes() + velocities_.size() * sizeof(double);
  if (damping_cost_ == nullptr) return;
  damping_.emplace(tissue, elements, inertia_.mass(), scene.damping.mass, scene.damping.stiffness);
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

EquilibriumReport Dynamics::advance(
    Equilibrium& equilibrium,
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& motion_left, double dt,
    Eigen::VectorXd& positions) {
  const int substeps = std::clamp(
      static_cast<int>(std::min(std::ceil(dt / scene_.inertia.substep), 1e6)), 1, kMaxSubsteps);
  const Eigen::VectorXd positions_before = positions, velocities_before = velocities_;
  EquilibriumReport report;
  report.converged = true;
  for (int done = 0; done < substeps && report.converged; ++done) {
    const Eigen::VectorXd motion = motion_left(positions) / (substeps - done);
    const EquilibriumReport one = substep(equilibrium, motion, dt / substeps, positions);
    report.converged = one.converged;
    report.iterations += one.iterations;
    report.residual = std::max(report.residual, one.residual);
  }
  if (!report.converged) {
    positions = positions_before;
    velocities_ = velocities_before;
  }
  count_quiet_steps();
  return report;
}

EquilibriumReport Dynamics::substep(Equilibrium& equilibrium, const Eigen::VectorXd& motion,
                                    double h, Eigen::VectorXd& positions) {
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
  EquilibriumOptions options = scene_.solver;
  options.max_iterations = scene_.inertia.iterations - 1;
  // A step that goes too far is found by line searches instead.
  if (!report.converged) {
    positions = start + motion;
    options.max_iterations = scene_.solver.max_iterations;
  }
  if (options.max_iterations > 0) {
    const int iterations = report.iterations;
    report = equilibrium.solve(positions, options);
    report.iterations += iterations;
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
