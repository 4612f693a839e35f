#pragma once

#include "tissue/simulate/constitutive.h"
#include "tissue/simulate/energy.h"
#include "tissue/simulate/finite_elements.h"

namespace tissue {

/// The strain energy of a body: the sum over elements and quadrature points of ψ(F) w V.
class ElasticEnergy : public Energy {
 public:
  /// `lame` holds one entry for each element; both references must outlive this.
  ElasticEnergy(const FiniteElements& elements, const std::vector<Lame>& lame,
                Constitution constitution, Run run = {})
      : elements_(elements), lame_(lame), constitution_(constitution), run_(std::move(run)) {}

  double value(const Eigen::VectorXd& positions) const override;
  void add_gradient(const Eigen::VectorXd& positions, Eigen::VectorXd& gradient) const override;
  void add_hessian(const Eigen::VectorXd& positions, BlockMatrix& hessian) const override;

  /// A matrix with a block wherever this energy adds one.
  BlockMatrix empty_hessian() const;
  /// The deformation gradient at a quadrature point.
  Mat3 deformation_gradient(std::size_t element, const QuadraturePoint& point,
                            const Eigen::VectorXd& positions) const;

 private:
  const FiniteElements& elements_;
  const std::vector<Lame>& lame_;
  Constitution constitution_;
  Run run_;
};

/// The potential of the bodies' weight, −∫ ρ g·x dV: linear in the positions.
class GravityEnergy : public Energy {
 public:
  /// `mass_density` [kg/m³], `gravity` [m/s²].
  GravityEnergy(const FiniteElements& elements, double mass_density, const Vec3& gravity);

  double value(const Eigen::VectorXd& positions) const override { return -weight_.dot(positions); }
  void add_gradient(const Eigen::VectorXd&, Eigen::VectorXd& gradient) const override {
    gradient -= weight_;
  }
  void add_hessian(const Eigen::VectorXd&, BlockMatrix&) const override {}

 private:
  Eigen::VectorXd weight_;
};

/// Positions of the nodes, three after three.
Eigen::VectorXd rest_positions(const FiniteElements& elements);

}  // namespace tissue
