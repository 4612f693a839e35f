#pragma once

#include "tissue/simulate/inertia.h"

namespace tissue {

/// Rayleigh's damping over a step of implicit Euler: what resists motion is (α M + β K) v with the
/// velocity v = (x − x₀)/h and the stiffness K at the step's start, so that a step loses
/// (x − x₀)ᵀ (α M + β K) (x − x₀) / (2 h).
class DampingEnergy : public Energy {
 public:
  /// α [1/s] and β [s]; references must outlive this.
  DampingEnergy(const Energy& tissue, const Eigen::SparseMatrix<double>& mass, double alpha,
                double beta, BlockMatrix empty_matrix);

  void begin_step(const Eigen::VectorXd& positions, double h);

  double value(const Eigen::VectorXd& positions) const override;
  void add_gradient(const Eigen::VectorXd& positions, Eigen::VectorXd& gradient) const override;
  void add_hessian(const Eigen::VectorXd& positions, BlockMatrix& hessian) const override;
  std::size_t bytes() const;

 private:
  Eigen::VectorXd resistance_to(const Eigen::VectorXd& motion) const;

  const Energy& tissue_;
  const Eigen::SparseMatrix<double>& mass_;
  double alpha_, beta_, h_ = 1.0;
  BlockMatrix stiffness_;
  Eigen::VectorXd start_;
};

}  // namespace tissue
