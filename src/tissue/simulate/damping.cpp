#include "tissue/simulate/damping.h"

#include "hessian_product.h"

namespace tissue {

void DampingEnergy::begin_step(const Eigen::VectorXd& positions, double h) {
  start_ = positions;
  h_ = h;
}

// The stiffness at the start is not kept but made anew where it is needed.
double DampingEnergy::evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                               Hessian* hessian) const {
  if (hessian != nullptr) {
    hessian->add_mass(mass_, alpha_ / h_);
    ScaledHessian scaled(*hessian, beta_ / h_);
    if (beta_ > 0.0) tissue_.evaluate(start_, nullptr, &scaled);
  }
  const Eigen::VectorXd motion = positions - start_;
  if (motion.isZero(0.0)) return 0.0;
  Eigen::VectorXd resistance = alpha_ / h_ * mass_.times(motion);
  if (beta_ > 0.0) {
    HessianProduct stiffness(elements_, motion);
    tissue_.evaluate(start_, nullptr, &stiffness);
    resistance += beta_ / h_ * stiffness.result();
  }
  if (gradient != nullptr) *gradient += resistance;
  return 0.5 * motion.dot(resistance);
}

}  // namespace tissue
