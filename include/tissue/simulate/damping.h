#pragma once

#include "tissue/simulate/energy.h"
#include "tissue/simulate/mass_matrix.h"

namespace tissue {

/// Rayleigh's damping over a step of implicit Euler: what resists motion is (α M + β K) v with the
/// velocity v = (x − x₀)/h and the stiffness K at the step's start, so that a step loses
/// (x − x₀)ᵀ (α M + β K) (x − x₀) / (2 h).
class DampingEnergy : public Energy {
 public:
  /// α [1/s] and β [s]; references must outlive this.
  DampingEnergy(const Energy& tissue, const FiniteElements& elements, const MassMatrix& mass,
                double alpha, double beta)
      : tissue_(tissue), elements_(elements), mass_(mass), alpha_(alpha), beta_(beta) {}

  void begin_step(const Eigen::VectorXd& positions, double h);

  double evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                  Hessian* hessian) const override;
  std::size_t bytes() const { return static_cast<std::size_t>(start_.size()) * sizeof(double); }

 private:
  const Energy& tissue_;
  const FiniteElements& elements_;
  const MassMatrix& mass_;
  double alpha_, beta_, h_ = 1.0;
  Eigen::VectorXd start_;
};

}  // namespace tissue
