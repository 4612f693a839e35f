#pragma once

#include "tissue/simulate/finite_elements.h"

#include <Eigen/Core>

namespace tissue {

/// Mass that couples each two nodes [kg], the same for all three axes: what each tet weighs, a
/// quarter at each corner, for order 1; ∫ ρ N_a N_b dV for order 2, where quarters and the like
/// would be negative. Either way the rows' sums are what gravity pulls at.
class MassMatrix {
 public:
  /// `density` [kg/m³]; elements must outlive this.
  MassMatrix(const FiniteElements& elements, double density);

  /// M x of vectors that come three after three.
  Eigen::VectorXd times(const Eigen::VectorXd& x) const;
  /// Calls body(a, b, mass) for pairs of nodes, each pair once in every element that has both, or
  /// once for all of them.
  template <class Body>
  void for_each_pair(const Body& body) const;
  /// At the vertices: rows' sums of the matrix for order 1.
  double at_vertex(std::size_t vertex) const { return lumped_[vertex]; }
  double density() const { return density_; }
  /// Of rigid tets at a vertex.
  double rigid_at_vertex(std::size_t vertex) const {
    return elements_.rigid_volumes().empty() ? 0.0 : density_ * elements_.rigid_volumes()[vertex];
  }
  std::size_t bytes() const { return lumped_.size() * sizeof(double); }

  /// ∫ N_a N_b over a tet of 10 nodes by 420 / V (Zienkiewicz and Taylor).
  static double quadratic_share(int a, int b);

 private:
  const FiniteElements& elements_;
  double density_;
  std::vector<double> lumped_;
};

template <class Body>
void MassMatrix::for_each_pair(const Body& body) const {
  if (elements_.order() == 1) {
    for (std::uint32_t node = 0; node < lumped_.size(); ++node) body(node, node, lumped_[node]);
    return;
  }
  for (std::uint32_t v = 0; v < elements_.rigid_volumes().size(); ++v) {
    body(v, v, rigid_at_vertex(v));
  }
  for (std::size_t e = 0; e < elements_.element_count(); ++e) {
    const std::uint32_t* nodes = elements_.nodes(e);
    const double unit = density_ * elements_.volume(e) / 420.0;
    for (int a = 0; a < 10; ++a) {
      for (int b = 0; b <= a; ++b) body(nodes[a], nodes[b], unit * quadratic_share(a, b));
    }
  }
}

}  // namespace tissue
