#pragma once

#include "tissue/simulate/block_matrix.h"

#include <memory>

namespace tissue {

/// A factorisation: solves A x = b over the coordinates of a block matrix that are free, for
/// symmetric positive definite A, prepared once for many b.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  /// Of the method.
  virtual const char* name() const = 0;
  /// Coordinates for which `fixed` is set, three flags for each node, have no equation; `shift` is
  /// added to the diagonal. False if A is seen not to be positive definite to working precision.
  /// Throws std::bad_alloc where the machine has too little memory for the factor.
  virtual bool prepare(const BlockMatrix& matrix, const std::vector<std::uint8_t>& fixed,
                       double shift) = 0;
  /// All coordinates, of which fixed ones are not looked at and answered with zero. False if no x
  /// was found.
  virtual bool solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) = 0;
};

/// CHOLMOD's supernodal factorisation where the package was built with it, else Eigen's own.
std::unique_ptr<LinearSolver> direct_solver();
/// Eigen's simplicial LDLᵀ.
std::unique_ptr<LinearSolver> eigen_solver();

}  // namespace tissue
