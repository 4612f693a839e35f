#pragma once

#include <Eigen/SparseCore>

#include <memory>

namespace tissue {

/// Solves A x = b for symmetric positive definite A, factorised once for many b.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  /// Takes the lower triangle. False if A is not positive definite, or not to working precision.
  virtual bool factorise(const Eigen::SparseMatrix<double>& lower) = 0;
  virtual Eigen::VectorXd solve(const Eigen::VectorXd& b) const = 0;
};

/// CHOLMOD's supernodal factorisation where the package was built with it, else Eigen's own.
std::unique_ptr<LinearSolver> direct_solver();
/// Eigen's simplicial LDLᵀ.
std::unique_ptr<LinearSolver> eigen_solver();

}  // namespace tissue
