#include "tissue/simulate/equilibrium.h"

#include "rigid_inclusions.h"
#include "tissue/base/error.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tissue {
namespace {

constexpr double kRounding = 1e-13;

// No coordinate moves farther in one iteration, by the body's extent. A body that is far from its
// equilibrium then comes to it, not to another one farther away: without this, tissue with a
// stiff tumour that was collapsed or turned inside out stayed entangled.
constexpr double kLongestStep = 0.1;

}  // namespace

double Equilibrium::extent(const Eigen::VectorXd& positions) {
  const Eigen::Map<const Eigen::Matrix3Xd> places(positions.data(), 3, positions.size() / 3);
  return (places.rowwise().maxCoeff() - places.rowwise().minCoeff()).norm();
}

Equilibrium::Equilibrium(std::vector<const Energy*> energies, std::unique_ptr<LinearSystem> system,
                         LinearSystemMaker fallback, bool quadratic, RigidMotions* motions)
    : energies_(std::move(energies)),
      system_(std::move(system)),
      make_fallback_(std::move(fallback)),
      active_(system_.get()),
      quadratic_(quadratic),
      motions_(motions) {}

void Equilibrium::hold(const std::vector<std::uint8_t>& fixed_nodes) {
  std::vector<std::uint8_t> coordinates;
  coordinates.reserve(3 * fixed_nodes.size());
  for (const std::uint8_t fixed : fixed_nodes) coordinates.insert(coordinates.end(), 3, fixed);
  hold_coordinates(coordinates);
}

void Equilibrium::hold_coordinates(const std::vector<std::uint8_t>& fixed) {
  if (std::find(fixed.begin(), fixed.end(), 0) == fixed.end()) {
    throw InputError(ErrorCode::kParam, "anchors: every vertex is held");
  }
  fixed_ = fixed;
  if (motions_ != nullptr) motions_->hold(fixed);
  is_prepared_ = false;
  system_->forget();
  if (fallback_) fallback_->forget();
}

std::size_t Equilibrium::unknowns() const {
  auto free = static_cast<std::size_t>(std::count(fixed_.begin(), fixed_.end(), 0));
  if (motions_ == nullptr) return free;
  for (const RigidMotions::Group& group : motions_->groups()) {
    if (!group.is_held) free -= 3 * group.nodes.size() - 6;
  }
  return free;
}

double Equilibrium::evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                             Hessian* hessian) const {
  double sum = 0.0;
  for (const Energy* energy : energies_) sum += energy->evaluate(positions, gradient, hessian);
  return sum;
}

Eigen::VectorXd Equilibrium::gradient(const Eigen::VectorXd& positions) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(positions.size());
  evaluate(positions, &sum, nullptr);
  return sum;
}

Eigen::VectorXd Equilibrium::penalties(const Eigen::VectorXd& positions) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(positions.size());
  for (const Energy* energy : energies_) {
    if (energy->is_penalty()) energy->evaluate(positions, &sum, nullptr);
  }
  return sum;
}

Eigen::VectorXd Equilibrium::moved(const Eigen::VectorXd& positions,
                                   const Eigen::VectorXd& motion) const {
  return motions_ != nullptr ? motions_->moved(positions, motion) : positions + motion;
}

// To what is free to move.
void Equilibrium::restrict(Eigen::VectorXd& forces) const {
  for (std::size_t i = 0; i < fixed_.size(); ++i) {
    if (fixed_[i] != 0) forces[static_cast<Eigen::Index>(i)] = 0.0;
  }
  if (motions_ != nullptr) motions_->project(forces);
}

double Equilibrium::norm_of(const Eigen::VectorXd& gradient, bool of_fixed) const {
  if (motions_ != nullptr && !of_fixed) {
    Eigen::VectorXd free = gradient;
    restrict(free);
    return free.norm();
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < fixed_.size(); ++i) {
    const double force = gradient[static_cast<Eigen::Index>(i)];
    if ((fixed_[i] != 0) == of_fixed) sum += force * force;
  }
  return std::sqrt(sum);
}

// Forces that are nothing but that are in balance.
bool Equilibrium::is_rounding(double force, const Eigen::VectorXd& positions) const {
  return force <= kRounding * largest_stiffness_ * extent(positions);
}

// The energy; is_prepared_ says whether the system can be solved. The gradient is made on the way
// where it is asked for.
double Equilibrium::prepare(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient) {
  if (gradient != nullptr) gradient->setZero(positions.size());
  if (fixed_.empty()) fixed_.assign(static_cast<std::size_t>(positions.size()), 0);
  if (quadratic_ && is_prepared_) return evaluate(positions, gradient, nullptr);
  active_ = system_.get();
  active_->set_zero();
  if (motions_ != nullptr) motions_->look_at(positions);
  const double energy = evaluate(positions, gradient, active_);
  is_prepared_ = prepare_active() || use_fallback(positions);
  return energy;
}

bool Equilibrium::prepare_active() {
  active_->finish();
  largest_stiffness_ = active_->largest_diagonal();
  if (!std::isfinite(largest_stiffness_)) return false;
  if (active_->prepare(fixed_, 0.0)) return true;
  if (active_ == system_.get() && make_fallback_) return false;
  // Flat directions of a convex neighbour of the Hessian: held by a little, then by more.
  for (double shift = 1e-10; shift < 1.0; shift *= 100.0) {
    if (active_->prepare(fixed_, shift * largest_stiffness_)) return true;
  }
  return false;
}

bool Equilibrium::use_fallback(const Eigen::VectorXd& positions) {
  is_prepared_ = false;
  if (!make_fallback_ || (fallback_ && active_ == fallback_.get())) return false;
  if (!fallback_) fallback_ = make_fallback_();
  active_ = fallback_.get();
  active_->set_zero();
  evaluate(positions, nullptr, active_);
  return prepare_active();
}

// The step that answers a pull, as far as the Hessian at `positions` says.
bool Equilibrium::solve_for(const Eigen::VectorXd& positions, const Eigen::VectorXd& pull,
                            Eigen::VectorXd& step) {
  if (!active_->solve(pull, step)) {
    is_prepared_ = use_fallback(positions);
    if (!is_prepared_ || !active_->solve(pull, step)) return false;
  }
  step = -step;
  return true;
}

bool Equilibrium::line_search(const Eigen::VectorXd& step, Eigen::VectorXd& gradient,
                              Eigen::VectorXd& positions, double& energy_now) const {
  constexpr double kArmijo = 1e-4;
  const double slope = gradient.dot(step);
  if (!(slope < 0.0) || !step.allFinite()) return false;
  const double before = norm_of(gradient, false), size = extent(positions);
  // Near the minimum what is gained drowns in the energy's rounding, also that of terms which
  // cancel at rest; forces still tell.
  const double noise =
      std::max(1e-9 * std::abs(energy_now), kRounding * largest_stiffness_ * size * size);
  const double farthest = step.cwiseAbs().maxCoeff();
  const double longest = quadratic_ ? 1.0 : kLongestStep * size / farthest;
  Eigen::VectorXd there, gradient_there;
  for (double length = std::min(1.0, longest); length > 1e-10; length *= 0.5) {
    there = moved(positions, length * step);
    gradient_there.setZero(positions.size());
    const double energy_there = evaluate(there, &gradient_there, nullptr);
    const bool lower = energy_there <= energy_now + kArmijo * length * slope;
    const bool drowned = -length * slope <= noise && std::abs(energy_there - energy_now) <= noise;
    if (!std::isfinite(energy_there)) continue;
    if (lower || (drowned && norm_of(gradient_there, false) < before)) {
      positions.swap(there);
      gradient.swap(gradient_there);
      energy_now = energy_there;
      return true;
    }
  }
  return false;
}

EquilibriumReport Equilibrium::linearised_step(Eigen::VectorXd& positions,
                                               const Eigen::VectorXd& motion) {
  EquilibriumReport report;
  report.iterations = 1;
  Eigen::VectorXd pull, step;
  double allowed = prepare(positions, &pull);
  if (!is_prepared_) return report;
  if (!motion.isZero(0.0)) {
    allowed = energy(positions + motion);
    active_->multiply_add(motion, pull);
  }
  const double before = norm_of(pull, false);
  if (motion.isZero(0.0) && is_rounding(before, positions)) {
    report.energy = allowed;
    report.converged = true;
    return report;
  }
  if (!solve_for(positions, pull, step)) return report;
  active_->multiply_add(step, pull);
  report.residual = before > 0.0 ? norm_of(pull, false) / before : 0.0;
  positions = moved(positions, motion + step);
  report.energy = energy(positions);
  report.converged = positions.allFinite() && report.energy <= allowed;
  return report;
}

EquilibriumReport Equilibrium::solve(Eigen::VectorXd& positions,
                                     const EquilibriumOptions& options) {
  if (fixed_.empty()) fixed_.assign(static_cast<std::size_t>(positions.size()), 0);
  EquilibriumReport report;
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(positions.size()), step;
  report.energy = evaluate(positions, &forces, nullptr);
  Eigen::VectorXd penalty = penalties(positions);
  const double at_start = norm_of(forces - penalty, false);
  for (;; ++report.iterations) {
    const double out_of_balance = norm_of(forces, false);
    if (report.iterations > 0) penalty = penalties(positions);
    const double scale = std::max({at_start, norm_of(forces, true), norm_of(penalty, false)});
    const bool is_nothing = is_rounding(out_of_balance, positions);
    report.residual = scale > 0.0 && !is_nothing ? out_of_balance / scale : 0.0;
    report.converged = report.residual <= options.tolerance;
    if (report.converged || report.iterations == options.max_iterations) return report;
    prepare(positions, nullptr);
    if (!is_prepared_ || !solve_for(positions, forces, step)) return report;
    if (!line_search(step, forces, positions, report.energy)) {
      // Nothing lower along the way downhill: as near as the numbers allow.
      report.converged = is_rounding(out_of_balance, positions);
      if (report.converged) report.residual = 0.0;
      return report;
    }
  }
}

}  // namespace tissue
