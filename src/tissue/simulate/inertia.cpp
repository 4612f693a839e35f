#include "tissue/simulate/inertia.h"

namespace tissue {

void InertiaEnergy::begin_step(const Eigen::VectorXd& positions, const Eigen::VectorXd& velocities,
                               double h) {
  free_flight_ = positions + h * velocities;
  h_ = h;
}

double InertiaEnergy::evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                               Hessian* hessian) const {
  const Eigen::VectorXd off = positions - free_flight_;
  const Eigen::VectorXd pull = mass_.times(off) / (h_ * h_);
  if (gradient != nullptr) *gradient += pull;
  if (hessian != nullptr) hessian->add_mass(mass_, 1.0 / (h_ * h_));
  return 0.5 * off.dot(pull);
}

std::size_t InertiaEnergy::bytes() const {
  return mass_.bytes() + static_cast<std::size_t>(free_flight_.size()) * sizeof(double);
}

}  // namespace tissue
