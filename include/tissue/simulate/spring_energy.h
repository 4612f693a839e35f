#pragma once

#include "tissue/simulate/energy.h"
#include "tissue/simulate/finite_elements.h"

namespace tissue {

/// Springs on the edges of a body, at rest in its rest shape.
///
/// A spring's stiffness is Σ E V / L² over the tets around its edge (Van Gelder, Approximate
/// Simulation of Elastic Membranes by Triangulated Spring Meshes, 1998). With it, springs whose
/// directions are spread evenly have the energy density of a solid with λ = μ = 2E/5: Young's
/// modulus is E and Poisson's ratio 1/4, whatever the material says, because Σ k L² = 6 E V and the
/// mean of n_i n_j n_k n_l over all directions is (δ_ij δ_kl + δ_ik δ_jl + δ_il δ_jk)/15.
class SpringEnergy : public Energy {
 public:
  /// `young` of each tet [Pa]. Elements of order 1; the reference must outlive this.
  SpringEnergy(const FiniteElements& elements, const std::vector<double>& young);

  /// The Hessian comes without what compression would take away, so that it stays positive
  /// semidefinite.
  double evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                  Hessian* hessian) const override;

 private:
  struct Spring {
    Edge ends;
    // [m], [N/m]
    double length, stiffness;
  };
  std::vector<Spring> springs_;
};

}  // namespace tissue
