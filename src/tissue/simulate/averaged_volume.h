#pragma once

#include "tissue/simulate/constitutive.h"
#include "tissue/simulate/energy.h"
#include "tissue/simulate/finite_elements.h"

namespace tissue {

/// What resists a change of volume, by averages around vertices instead of element by element: Σ_a
/// ½ (Σ_e c_ae θ_e)² / Σ_e c_ae, where θ is J − 1 (the trace of ε for small strain) and c_ae = λ ∫
/// N_a dV with the linear shape function of vertex a. Each average is a pressure's; around a vertex
/// there is one for each order of magnitude of λ, because pressure jumps where stiffness does.
///
/// There are fewer of these than nodes, so that tissue can keep its volume and still bend: linear
/// tets lock because they have as many elements' volumes to keep as nodes to do it with. For order
/// 1 it is the average nodal pressure of Bonet and Burton (Communications in Numerical Methods in
/// Engineering 14, 1998), for order 2 Taylor and Hood's element with the pressure condensed out.
class AveragedVolumeEnergy : public Energy {
 public:
  /// `lambda` of each element [Pa]; elements must outlive this.
  AveragedVolumeEnergy(const FiniteElements& elements, const std::vector<double>& lambda,
                       Constitution constitution);

  double evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                  Hessian* hessian) const override;
  bool is_penalty() const override { return true; }
  /// Of this, and of the squares that a linear system keeps of it.
  std::size_t bytes() const;

 private:
  template <int order>
  double evaluate_order(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                        Hessian* hessian) const;
  void find_averages();
  void find_squares();

  const FiniteElements& elements_;
  std::vector<double> lambda_;
  bool is_small_strain_;
  // Of each element's corners; Σ c_ae of each.
  std::vector<std::array<std::uint32_t, 4>> averages_;
  std::vector<double> weights_;
  // How each average changes with the nodes, and where in it each node of each element is, for each
  // of its corners.
  mutable SquareSum squares_;
  std::vector<std::uint32_t> places_;
};

}  // namespace tissue
