#pragma once

#include "block_rows.h"
#include "tissue/base/run.h"
#include "tissue/simulate/finite_elements.h"
#include "tissue/simulate/hessian.h"

namespace tissue {

/// A Hessian over the vertices of a body, in single precision, for iterative solvers. Of quadratic
/// elements it is what remains where midpoints stay half-way between their ends.
class VertexHessian : public Hessian {
 public:
  /// Rows come in an order that `place_of` says for each vertex; references must outlive this.
  VertexHessian(const FiniteElements& elements, const std::vector<std::uint32_t>& place_of,
                Run run);

  void set_zero();
  void add(std::uint32_t a, std::uint32_t b, const Mat3& block) override;
  void add_mass(const MassMatrix& mass, double factor) override;
  void add_elements(std::size_t first_pack, const std::vector<MaterialTensor>& tensors) override;
  /// To be called when everything has been added, before the rows are looked at.
  void finish();
  const BlockRows& rows() const { return rows_; }
  BlockRows& rows() { return rows_; }
  /// The largest entry of the diagonal; not finite if one of them is not.
  double largest_diagonal() const;

 private:
  const FiniteElements& elements_;
  const std::vector<std::uint32_t>& place_of_;
  Run run_;
  BlockRows rows_;
  // Of each element the blocks of its six pairs of corners, in either triangle; both triangles are
  // added up in the end.
  std::vector<std::array<std::uint32_t, 6>> pairs_;
  // For each block above the diagonal, in order, the one across.
  std::vector<std::uint32_t> across_;
  // What the diagonal has beyond minus the sum of the rest of its row.
  std::vector<Mat3> own_;
  bool is_finished_ = false;
  // For each piece of elements that is added at once, blocks one after another.
  std::vector<float> buffer_;
};

}  // namespace tissue
