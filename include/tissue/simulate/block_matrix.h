#pragma once

#include "tissue/base/types.h"

#include <Eigen/SparseCore>

#include <cstddef>
#include <vector>

namespace tissue {

/// A symmetric matrix of 3×3 blocks, a row for each node, of which the lower triangle is kept.
/// Where blocks can be is fixed from the start.
class BlockMatrix {
 public:
  BlockMatrix() = default;
  /// Nodes of each of `groups`, `group_size` a time, are joined with each other; each has a block of
  /// its own.
  BlockMatrix(std::size_t node_count, const std::vector<std::uint32_t>& groups, int group_size);

  void set_zero();
  /// Adds a block to row `a` and column `b`; the transposed block counts as added to (b, a).
  void add(std::uint32_t a, std::uint32_t b, const Mat3& block);
  std::size_t node_count() const { return begin_.empty() ? 0 : begin_.size() - 1; }
  /// The largest entry of the diagonal; not finite if one of them is not.
  double largest_diagonal() const;
  /// result += A x, nodes numbered three after three.
  void multiply_add(const Eigen::VectorXd& x, Eigen::VectorXd& result) const;

  /// The lower triangle of the rows and columns that `number` numbers (those with −1 are left out).
  Eigen::SparseMatrix<double> lower_triangle(const std::vector<int>& number, int count) const;

 private:
  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> columns_;
  std::vector<Mat3> blocks_;
};

}  // namespace tissue
