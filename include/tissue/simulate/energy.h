#pragma once

#include "tissue/simulate/hessian.h"

#include <Eigen/Core>

namespace tissue {

/// What a deformed body stores or loses: elasticity, gravity, springs. Positions of the nodes come
/// three after three [m]. The same bits for any number of threads.
class Energy {
 public:
  virtual ~Energy() = default;
  /// [J]; infinite where the state is not valid. Where they are asked for, dE/dx [N], which is the
  /// negative of the force, is added to `gradient` and d²E/dx² [N/m] to `hessian`, or where that is
  /// indefinite a positive semidefinite matrix near it.
  virtual double evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                          Hessian* hessian) const = 0;

  /// True of one that stands for a constraint: far from a solution its forces are larger than any
  /// that are meant.
  virtual bool is_penalty() const { return false; }

  double value(const Eigen::VectorXd& positions) const {
    return evaluate(positions, nullptr, nullptr);
  }
  Eigen::VectorXd gradient(const Eigen::VectorXd& positions) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(positions.size());
    evaluate(positions, &result, nullptr);
    return result;
  }
};

}  // namespace tissue
