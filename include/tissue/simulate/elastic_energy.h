#pragma once

#include "tissue/base/run.h"
#include "tissue/simulate/constitutive.h"
#include "tissue/simulate/energy.h"
#include "tissue/simulate/finite_elements.h"

namespace tissue {

/// The strain energy of a body: the sum over elements and quadrature points of ψ(F) w V.
class ElasticEnergy : public Energy {
 public:
  /// `lame` holds one entry for each element; elements must outlive this.
  ElasticEnergy(const FiniteElements& elements, const std::vector<Lame>& lame,
                Constitution constitution, Run run = {});

  double evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                  Hessian* hessian) const override;

  /// The deformation gradient at a quadrature point.
  Mat3 deformation_gradient(std::size_t element, const QuadraturePoint& point,
                            const Eigen::VectorXd& positions) const;
  Lame lame(std::size_t element) const {
    const LameLanes& lanes = lame_[element / kLanes];
    return {lanes.mu[element % kLanes], lanes.lambda[element % kLanes]};
  }
  Constitution constitution() const { return constitution_; }
  std::size_t bytes() const { return lame_.size() * sizeof(LameLanes); }

 private:
  template <int order>
  double evaluate_order(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                        Hessian* hessian) const;

  const FiniteElements& elements_;
  std::vector<LameLanes> lame_;
  Constitution constitution_;
  Run run_;
};

}  // namespace tissue
