#pragma once

#include "tissue/simulate/energy.h"
#include "tissue/simulate/finite_elements.h"

namespace tissue {

/// The potential of a body's weight, −∫ ρ g·x dV: linear in the positions.
class GravityEnergy : public Energy {
 public:
  /// `mass_density` [kg/m³], `gravity` [m/s²].
  GravityEnergy(const FiniteElements& elements, double mass_density, const Vec3& gravity);

  double evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                  Hessian*) const override {
    if (gradient != nullptr) *gradient -= weight_;
    return -weight_.dot(positions);
  }
  std::size_t bytes() const { return static_cast<std::size_t>(weight_.size()) * sizeof(double); }

 private:
  Eigen::VectorXd weight_;
};

}  // namespace tissue
