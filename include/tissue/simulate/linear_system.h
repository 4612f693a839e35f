#pragma once

#include "tissue/simulate/finite_elements.h"
#include "tissue/simulate/hessian.h"

#include <Eigen/Core>

#include <functional>
#include <memory>

namespace tissue {

/// A symmetric positive semidefinite matrix over the coordinates of nodes, three after three, and a
/// way to solve with it. It is summed up from zero, multiplied with, and solved with.
class LinearSystem : public Hessian {
 public:
  /// Of the method.
  virtual const char* name() const = 0;
  virtual void set_zero() = 0;
  /// To be called when everything has been added, before anything is asked.
  virtual void finish() {}
  /// The largest entry of the diagonal; not finite if one of them is not.
  virtual double largest_diagonal() const = 0;
  /// result += A x
  virtual void multiply_add(const Eigen::VectorXd& x, Eigen::VectorXd& result) const = 0;
  /// Coordinates for which `fixed` is set, three flags for each node, have no equation; `shift` is
  /// added to the diagonal of what is solved; iterative methods take none but 0. False if A is seen
  /// not to be positive definite to working precision.
  virtual bool prepare(const std::vector<std::uint8_t>& fixed, double shift) = 0;
  /// A x = b. All coordinates, of which fixed ones are not looked at and answered with zero. False
  /// if no x was found.
  virtual bool solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) = 0;
  /// z = M⁻¹ r with an M near A: what conjugate gradients over A go by. False if there is none.
  virtual bool precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) = 0;
  /// Forgets what it kept of earlier matrices to be quicker with the next: its answers are then
  /// those of a new one, to the last bit.
  virtual void forget() {}
};

/// Factorises: CHOLMOD's supernodal way where the package was built with it, else as below.
std::unique_ptr<LinearSystem> direct_system(const FiniteElements& elements);
/// Factorises by Eigen's simplicial LDLᵀ.
std::unique_ptr<LinearSystem> eigen_system(const FiniteElements& elements);

/// Makes one when it is needed.
using LinearSystemMaker = std::function<std::unique_ptr<LinearSystem>()>;

}  // namespace tissue
