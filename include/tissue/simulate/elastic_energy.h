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

  /// The deformation gradient at a quadrature point.
  Mat3 deformation_gradient(std::size_t element, const QuadraturePoint& point,
                            const Eigen::VectorXd& positions) const;

 private:
  const FiniteElements& elements_;
  const std::vector<Lame>& lame_;
  Constitution constitution_;
  Run run_;
};

}  // namespace tissue
