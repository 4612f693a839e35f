#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace tissue {

/// Adds factor · from to a block of nine numbers.
inline void add_block(float factor, const float* from, float* to) {
  using Eight = float __attribute__((vector_size(32)));
  Eight add, sum;
  std::memcpy(&add, from, sizeof add);
  std::memcpy(&sum, to, sizeof sum);
  sum += factor * add;
  std::memcpy(to, &sum, sizeof sum);
  to[8] += factor * from[8];
}

/// A symmetric matrix of 3×3 blocks in single precision, all of each row, for iterative solvers.
/// Vectors come three after three, with one number more behind the last, which is not looked at.
class BlockRows {
 public:
  BlockRows() = default;
  /// Zeros in the named columns of each row, which must be symmetric, and on the diagonal.
  BlockRows(std::size_t row_count, std::vector<std::vector<std::uint32_t>> columns_of_rows);

  std::size_t row_count() const { return begin_.empty() ? 0 : begin_.size() - 1; }
  std::size_t block_count() const { return columns_.size(); }
  std::uint32_t begin(std::size_t row) const { return begin_[row]; }
  std::uint32_t end(std::size_t row) const { return begin_[row + 1]; }
  std::uint32_t diagonal(std::size_t row) const { return diagonal_[row]; }
  std::uint32_t column(std::uint32_t block) const { return columns_[block]; }
  /// Number of the block at a row and column that have one.
  std::uint32_t find(std::uint32_t row, std::uint32_t column) const;
  /// Nine numbers, column by column.
  float* block(std::uint32_t number) { return &values_[9 * std::size_t{number}]; }
  const float* block(std::uint32_t number) const { return &values_[9 * std::size_t{number}]; }
  void set_zero();

  /// Makes ready to sweep over the coordinates for which `fixed` is not set, three flags for each
  /// row: inverts the diagonal's blocks without what is fixed, the diagonal made larger by a part
  /// `hold` of itself. Nothing resists where it is zero. False unless all blocks are positive
  /// definite.
  bool invert_diagonal(const std::vector<std::uint8_t>& fixed, float hold);

  /// result = A x, x and result in double precision.
  void multiply(const double* x, double* result) const;
  /// The first sweep of Gauss and Seidel for A x = b, from x = 0. What is fixed stays zero.
  void sweep_from_zero(const float* b, float* x) const;
  /// residual = b − A x after that sweep, but for what is fixed.
  void residual_after_sweep(const float* x, float* residual) const;
  /// A sweep in the opposite order.
  void sweep_back(const float* b, float* x) const;

 private:
  std::vector<std::uint32_t> begin_, columns_, diagonal_;
  std::vector<float> values_, inverse_diagonal_;
};

}  // namespace tissue
