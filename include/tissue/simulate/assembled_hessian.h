#pragma once

#include "tissue/simulate/block_matrix.h"
#include "tissue/simulate/finite_elements.h"
#include "tissue/simulate/hessian.h"

namespace tissue {

/// All of a Hessian, as a matrix in double precision.
class AssembledHessian : public Hessian {
 public:
  /// Elements must outlive this.
  explicit AssembledHessian(const FiniteElements& elements);

  BlockMatrix& matrix() { return matrix_; }
  const BlockMatrix& matrix() const { return matrix_; }

  void add(std::uint32_t a, std::uint32_t b, const Mat3& block) override {
    matrix_.add(a, b, block);
  }
  void add_mass(const MassMatrix& mass, double factor) override;
  void add_elements(std::size_t first_pack, const std::vector<MaterialTensor>& tensors) override;

 private:
  template <int order>
  void add_elements_of_order(std::size_t first_pack, const std::vector<MaterialTensor>& tensors);

  const FiniteElements& elements_;
  BlockMatrix matrix_;
};

}  // namespace tissue
