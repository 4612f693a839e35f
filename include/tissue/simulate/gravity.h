#pragma once

#include "tissue/simulate/energy.h"
#include "tissue/simulate/finite_elements.h"

namespace tissue {

/// The potential of a body's weight, −∫ ρ g·x dV: linear in the positions.
class GravityEnergy : public Energy {
 public:
  /// `mass_density` [kg/m³], `gravity` [m/s²].
  GravityEnergy(const FiniteElements& elements, double mass_density, const Vec3& gravity);

  double value(const Eigen::VectorXd& positions) const override { return -weight_.dot(positions); }
  void add_gradient(const Eigen::VectorXd&, Eigen::VectorXd& gradient) const override {
    gradient -= weight_;
  }
  void add_hessian(const Eigen::VectorXd&, BlockMatrix&) const override {}
  std::size_t bytes() const { return static_cast<std::size_t>(weight_.size()) * sizeof(double); }

 private:
  Eigen::VectorXd weight_;
};

}  // namespace tissue
