#pragma once

#include "tissue/simulate/energy.h"
#include "tissue/simulate/finite_elements.h"

namespace tissue {

/// Mass that couples each two nodes [kg], the same for all three axes: what each tet weighs, a
/// quarter at each corner, for order 1; ∫ ρ N_a N_b dV for order 2, where quarters and the like
/// would be negative. Either way the rows' sums are what gravity pulls at.
Eigen::SparseMatrix<double> mass_matrix(const FiniteElements& elements, double mass_density);

/// M x of positions that come three after three.
Eigen::VectorXd times_mass(const Eigen::SparseMatrix<double>& mass, const Eigen::VectorXd& x);

/// Adds factor · M to a block matrix, the same on all three axes.
void add_scaled_mass(const Eigen::SparseMatrix<double>& mass, double factor, BlockMatrix& matrix);

/// What implicit Euler adds to the energy that a step of h seconds makes as small as it can: a half
/// (x − y)ᵀ M (x − y) / h² with y = x₀ + h v₀, where a body would fly that nothing pulls at.
class InertiaEnergy : public Energy {
 public:
  InertiaEnergy(const FiniteElements& elements, double mass_density)
      : mass_(mass_matrix(elements, mass_density)) {}

  /// From positions [m] and velocities [m/s].
  void begin_step(const Eigen::VectorXd& positions, const Eigen::VectorXd& velocities, double h);
  const Eigen::VectorXd& free_flight() const { return free_flight_; }
  const Eigen::SparseMatrix<double>& mass() const { return mass_; }

  double value(const Eigen::VectorXd& positions) const override;
  void add_gradient(const Eigen::VectorXd& positions, Eigen::VectorXd& gradient) const override;
  void add_hessian(const Eigen::VectorXd& positions, BlockMatrix& hessian) const override;
  std::size_t bytes() const;

 private:
  Eigen::SparseMatrix<double> mass_;
  Eigen::VectorXd free_flight_;
  double h_ = 1.0;
};

}  // namespace tissue
