#pragma once

#include "tissue/simulate/energy.h"
#include "tissue/simulate/mass_matrix.h"

namespace tissue {

/// What implicit Euler adds to the energy that a step of h seconds makes as small as it can: a half
/// (x − y)ᵀ M (x − y) / h² with y = x₀ + h v₀, where a body would fly that nothing pulls at.
class InertiaEnergy : public Energy {
 public:
  InertiaEnergy(const FiniteElements& elements, double mass_density)
      : mass_(elements, mass_density) {}

  /// From positions [m] and velocities [m/s].
  void begin_step(const Eigen::VectorXd& positions, const Eigen::VectorXd& velocities, double h);
  const MassMatrix& mass() const { return mass_; }

  double evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                  Hessian* hessian) const override;
  std::size_t bytes() const;

 private:
  MassMatrix mass_;
  Eigen::VectorXd free_flight_;
  double h_ = 1.0;
};

}  // namespace tissue
