#pragma once

#include "tissue/simulate/finite_elements.h"
#include "tissue/simulate/constitutive.h"
#include "tissue/simulate/hessian.h"

#include <memory>

namespace tissue {

/// The stiffness and mass of quadratic elements as what they do to vectors: never a matrix, for
/// that takes four times the memory and more time. In single precision; displacements are taken
/// from an element's first node on, so that little of them is lost.
class QuadraticOperator {
 public:
  virtual ~QuadraticOperator() = default;
  virtual void set_zero() { mass_ = 0.0; }
  /// All elements, from the first pack on; as often as there are energies that have them.
  virtual void add_elements(std::size_t first_pack, const std::vector<MaterialTensor>& tensors) = 0;
  /// `density` [kg/(m³ s²)].
  void add_mass(double density) { mass_ += density; }
  /// result += A x
  virtual void multiply_add(const double* x, double* result) const = 0;
  /// The same without mass, to precondition with.
  virtual void add_stiffness(const float* x, float* result) const = 0;
  double mass() const { return mass_; }

 protected:
  double mass_ = 0.0;
};

/// Elements must outlive it.
std::unique_ptr<QuadraticOperator> quadratic_operator(const FiniteElements& elements,
                                                      Constitution constitution);

}  // namespace tissue
