#pragma once

#include "tissue/simulate/equilibrium.h"

namespace tissue {

/// How a linear body answers when what is held moves: a superposition of columns, one for each way
/// of moving it by a unit, computed once. A step then solves nothing.
class LinearResponse {
 public:
  /// `base`: positions of all nodes at an equilibrium [m]; `motions` of held nodes, a multiple of
  /// three; `watched` nodes, of which gradients are known too.
  LinearResponse(Equilibrium& equilibrium, const Eigen::VectorXd& base,
                 const std::vector<Eigen::VectorXd>& motions,
                 const std::vector<std::size_t>& watched);

  /// Positions of the first vertices: base + Σ amount · column. In single precision, unless all
  /// amounts are zero, in one pass for each three columns whose amounts are not: reading it all
  /// takes longer than adding it up.
  void superpose(const Eigen::VectorXd& amounts, std::vector<Vec3>& positions) const;
  /// The same for all nodes, with the base in double precision.
  Eigen::VectorXd superpose(const Eigen::VectorXd& amounts) const;

  /// Positions of the watched nodes, and dE/dx there [N].
  Eigen::VectorXd watched_positions(const Eigen::VectorXd& amounts) const;
  Eigen::VectorXd watched_gradient(const Eigen::VectorXd& amounts) const;
  /// How the vertices and after them other nodes move by a unit of each amount.
  const std::vector<std::vector<float>>& columns() const { return columns_; }
  /// [J]; exact, because the energy is quadratic.
  double energy(const Eigen::VectorXd& amounts) const;

 private:
  template <class From>
  void superpose(const Eigen::VectorXd& amounts, const From* base, double* positions,
                 std::size_t count) const;

  Eigen::VectorXd base_;
  std::vector<float> float_base_;
  std::vector<std::vector<float>> columns_;
  // Of the watched nodes: at the base, and by the amounts.
  Eigen::VectorXd watched_base_, watched_base_gradient_;
  Eigen::MatrixXd watched_columns_, watched_forces_;
  // The energy at the base, and its derivatives by the amounts there.
  double base_energy_;
  Eigen::VectorXd slopes_;
  Eigen::MatrixXd curvatures_;
};

}  // namespace tissue
