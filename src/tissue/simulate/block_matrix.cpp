#include "tissue/simulate/block_matrix.h"

#include <algorithm>
#include <cmath>

namespace tissue {

BlockMatrix::BlockMatrix(std::size_t node_count, const std::vector<std::uint32_t>& groups,
                         int group_size) {
  const auto size = static_cast<std::size_t>(group_size);
  std::vector<std::vector<std::uint32_t>> rows(node_count);
  for (std::uint32_t row = 0; row < node_count; ++row) rows[row].push_back(row);
  for (std::size_t group = 0; group < groups.size(); group += size) {
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j) {
        const std::uint32_t row = groups[group + i], column = groups[group + j];
        if (column <= row) rows[row].push_back(column);
      }
    }
  }
  begin_.reserve(node_count + 1);
  begin_.push_back(0);
  for (std::vector<std::uint32_t>& row : rows) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    columns_.insert(columns_.end(), row.begin(), row.end());
    begin_.push_back(columns_.size());
    row = {};
  }
  blocks_.resize(columns_.size());
  set_zero();
}

void BlockMatrix::set_zero() { std::fill(blocks_.begin(), blocks_.end(), Mat3::Zero()); }

void BlockMatrix::add(std::uint32_t a, std::uint32_t b, const Mat3& block) {
  const std::uint32_t row = std::max(a, b), column = std::min(a, b);
  const auto begin = columns_.begin() + static_cast<std::ptrdiff_t>(begin_[row]);
  const auto end = columns_.begin() + static_cast<std::ptrdiff_t>(begin_[row + 1]);
  Mat3& place = blocks_[std::lower_bound(begin, end, column) - columns_.begin()];
  if (a >= b) {
    place += block;
  } else {
    place += block.transpose();
  }
}

double BlockMatrix::largest_diagonal() const {
  double largest = 0.0, sum = 0.0;
  // The last block of a row of the lower triangle is the diagonal's.
  for (std::size_t row = 0; row < node_count(); ++row) {
    if (begin_[row + 1] == begin_[row]) continue;
    const Vec3 diagonal = blocks_[begin_[row + 1] - 1].diagonal();
    largest = std::max(largest, diagonal.maxCoeff());
    sum += diagonal.sum();
  }
  return std::isfinite(sum) ? largest : sum;
}

void BlockMatrix::multiply_add(const Eigen::VectorXd& x, Eigen::VectorXd& result) const {
  for (std::size_t row = 0; row < node_count(); ++row) {
    const auto i = static_cast<Eigen::Index>(3 * row);
    for (std::size_t k = begin_[row]; k < begin_[row + 1]; ++k) {
      const auto j = static_cast<Eigen::Index>(3 * columns_[k]);
      result.segment<3>(i) += blocks_[k] * x.segment<3>(j);
      if (i != j) result.segment<3>(j) += blocks_[k].transpose() * x.segment<3>(i);
    }
  }
}

Eigen::SparseMatrix<double> BlockMatrix::lower_triangle(const std::vector<int>& number,
                                                        int count) const {
  // Numbers ascend with the nodes, so that rows of the lower triangle stay in it; by columns, as
  // Eigen keeps it, this is the upper triangle's transpose.
  Eigen::SparseMatrix<double, Eigen::RowMajor> rows(count, count);
  Eigen::VectorXi sizes = Eigen::VectorXi::Zero(count);
  const auto for_each = [&](const auto& body) {
    for (std::size_t row = 0; row < node_count(); ++row) {
      for (int i = 0; i < 3; ++i) {
        const int r = number[3 * row + static_cast<std::size_t>(i)];
        if (r < 0) continue;
        for (std::size_t k = begin_[row]; k < begin_[row + 1]; ++k) {
          for (int j = 0; j < 3; ++j) {
            const int c = number[3 * std::size_t{columns_[k]} + static_cast<std::size_t>(j)];
            if (c >= 0 && c <= r) body(r, c, blocks_[k](i, j));
          }
        }
      }
    }
  };
  for_each([&](int r, int, double) { ++sizes[r]; });
  rows.reserve(sizes);
  for_each([&](int r, int c, double value) { rows.insert(r, c) = value; });
  rows.makeCompressed();
  return rows;
}

}  // namespace tissue
