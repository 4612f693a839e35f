#pragma once

#include <Eigen/Core>

#include <cmath>

namespace tissue {

/// Conjugate gradients for A x = b from x = 0, until ‖b − A x‖ ≤ tolerance ‖b‖, in truth and not
/// only as summed up step by step. `multiply(x, result)` and `precondition(residual, result)` say
/// what A and the inverse of something like it do. The number of iterations, or −1 where they did
/// not lead there.
template <class Multiply, class Precondition>
int conjugate_gradients(const Eigen::VectorXd& b, double tolerance, const Multiply& multiply,
                        const Precondition& precondition, Eigen::VectorXd& x) {
  // What is not found within so many iterations is left to others.
  constexpr int kMaxIterations = 500;
  const double wanted = tolerance * b.norm();
  x.setZero(b.size());
  if (!std::isfinite(wanted)) return -1;
  Eigen::VectorXd residual = b, direction, z(b.size()), product(b.size());
  double before = 0.0;
  for (int i = 0; i < kMaxIterations; ++i) {
    if (residual.norm() <= wanted) {
      multiply(x, product);
      residual = b - product;
      if (residual.norm() <= wanted) return i;
      before = 0.0;
    }
    precondition(residual, z);
    const double now = residual.dot(z);
    if (!(now > 0.0)) return -1;
    if (before > 0.0) {
      direction = z + now / before * direction;
    } else {
      direction = z;
    }
    before = now;
    multiply(direction, product);
    const double curvature = direction.dot(product);
    if (!(curvature > 0.0)) return -1;
    x += now / curvature * direction;
    residual -= now / curvature * product;
  }
  return -1;
}

}  // namespace tissue
