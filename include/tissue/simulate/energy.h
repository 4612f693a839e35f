#pragma once

#include "tissue/base/run.h"
#include "tissue/simulate/block_matrix.h"

namespace tissue {

/// What a deformed body stores or loses: elasticity, gravity, springs. Positions of the nodes come
/// three after three [m]. The same bits for any number of threads.
class Energy {
 public:
  virtual ~Energy() = default;
  /// [J]; infinite where the state is not valid.
  virtual double value(const Eigen::VectorXd& positions) const = 0;
  /// Adds dE/dx [N], the negative of the force.
  virtual void add_gradient(const Eigen::VectorXd& positions, Eigen::VectorXd& gradient) const = 0;
  /// Adds d²E/dx² [N/m], or where that is indefinite a positive semidefinite matrix near it.
  virtual void add_hessian(const Eigen::VectorXd& positions, BlockMatrix& hessian) const = 0;
};

}  // namespace tissue
