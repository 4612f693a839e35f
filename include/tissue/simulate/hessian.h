#pragma once

#include "tissue/base/types.h"
#include "tissue/simulate/lanes.h"

#include <cstddef>
#include <vector>

namespace tissue {

class MassMatrix;
template <class L>
struct MaterialTensorOf;
using MaterialTensor = MaterialTensorOf<Lanes>;

/// A matrix Σ r rᵀ: rows r over the nodes, three numbers each, of which most are zero.
struct SquareSum {
  /// Of each row, and the end of the last.
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> nodes;
  std::vector<Vec3> values;

  /// result += Σ r rᵀ x
  void multiply_add(const Eigen::VectorXd& x, Eigen::VectorXd& result) const;
  std::size_t bytes() const {
    return (begin.size() + nodes.size()) * sizeof(std::uint32_t) + values.size() * sizeof(Vec3);
  }
};

/// What takes the second derivatives of energies by the positions of nodes [N/m], and keeps as much
/// of them as it is for: a matrix, a product.
class Hessian {
 public:
  virtual ~Hessian() = default;
  /// Adds a block to row `a` and column `b`; the transposed block counts as added to (b, a).
  virtual void add(std::uint32_t a, std::uint32_t b, const Mat3& block) = 0;
  /// Adds factor · M [factor in 1/s²].
  virtual void add_mass(const MassMatrix& mass, double factor) = 0;
  /// Adds elements by d²ψ/dF² at their quadrature points, times the point's weight and the
  /// element's volume: pack by pack and point by point, from the first pack on. An energy adds all
  /// of its elements, pieces of them in order.
  virtual void add_elements(std::size_t first_pack, const std::vector<MaterialTensor>& tensors) = 0;
  /// Adds rows that reach farther than elements. Throws std::logic_error where there is no room for
  /// them.
  virtual void add_squares(const SquareSum& squares);
};

}  // namespace tissue
