#include "tissue/simulate/damping.h"

#include <utility>

namespace tissue {

DampingEnergy::DampingEnergy(const Energy& tissue, const Eigen::SparseMatrix<double>& mass,
                             double alpha, double beta, BlockMatrix empty_matrix)
    : tissue_(tissue), mass_(mass), alpha_(alpha), beta_(beta) {
  if (beta_ > 0.0) stiffness_ = std::move(empty_matrix);
}

void DampingEnergy::begin_step(const Eigen::VectorXd& positions, double h) {
  start_ = positions;
  h_ = h;
  if (beta_ == 0.0) return;
  stiffness_.set_zero();
  tissue_.add_hessian(positions, stiffness_);
}

// (α M + β K) · motion.
Eigen::VectorXd DampingEnergy::resistance_to(const Eigen::VectorXd& motion) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(motion.size());
  if (beta_ > 0.0) stiffness_.multiply_add(motion, result);
  return alpha_ * times_mass(mass_, motion) + beta_ * result;
}

double DampingEnergy::value(const Eigen::VectorXd& positions) const {
  const Eigen::VectorXd motion = positions - start_;
  return 0.5 / h_ * motion.dot(resistance_to(motion));
}

void DampingEnergy::add_gradient(const Eigen::VectorXd& positions,
                                 Eigen::VectorXd& gradient) const {
  gradient += resistance_to(positions - start_) / h_;
}

void DampingEnergy::add_hessian(const Eigen::VectorXd&, BlockMatrix& hessian) const {
  add_scaled_mass(mass_, alpha_ / h_, hessian);
  if (beta_ > 0.0) hessian.add(stiffness_, beta_ / h_);
}

std::size_t DampingEnergy::bytes() const {
  return stiffness_.bytes() + static_cast<std::size_t>(start_.size()) * sizeof(double);
}

}  // namespace tissue
