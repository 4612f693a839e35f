#include "block_rows.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cstring>

namespace tissue {
namespace {

// Three numbers in one register; the fourth is not looked at.
using Three = float __attribute__((vector_size(16)));
using WideThree = double __attribute__((vector_size(32)));

inline Three load(const float* from) {
  Three result;
  std::memcpy(&result, from, sizeof result);
  return result;
}
inline void store(const Three& value, float* to) { std::memcpy(to, &value, 3 * sizeof(float)); }

// Block times vector.
inline Three times(const float* block, const float* x) {
  return load(block) * x[0] + load(block + 3) * x[1] + load(block + 6) * x[2];
}
inline WideThree times(const float* block, const double* x) {
  const auto wide = [](const float* from) {
    return __builtin_convertvector(load(from), WideThree);
  };
  return wide(block) * x[0] + wide(block + 3) * x[1] + wide(block + 6) * x[2];
}

}  // namespace

BlockRows::BlockRows(std::size_t row_count,
                     std::vector<std::vector<std::uint32_t>> columns_of_rows) {
  begin_.reserve(row_count + 1);
  begin_.push_back(0);
  for (std::uint32_t row = 0; row < row_count; ++row) {
    std::vector<std::uint32_t>& columns = columns_of_rows[row];
    columns.push_back(row);
    std::sort(columns.begin(), columns.end());
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    const auto diagonal = std::lower_bound(columns.begin(), columns.end(), row) - columns.begin();
    diagonal_.push_back(static_cast<std::uint32_t>(columns_.size()) +
                        static_cast<std::uint32_t>(diagonal));
    columns_.insert(columns_.end(), columns.begin(), columns.end());
    begin_.push_back(static_cast<std::uint32_t>(columns_.size()));
    columns = {};
  }
  // Four numbers are read where three are meant.
  values_.assign(9 * columns_.size() + 1, 0.0f);
  inverse_diagonal_.assign(9 * row_count + 1, 0.0f);
}

std::uint32_t BlockRows::find(std::uint32_t row, std::uint32_t column) const {
  const auto from = columns_.begin() + begin_[row], to = columns_.begin() + begin_[row + 1];
  return static_cast<std::uint32_t>(std::lower_bound(from, to, column) - columns_.begin());
}

void BlockRows::set_zero() { std::fill(values_.begin(), values_.end(), 0.0f); }

void BlockRows::clear_fixed(const std::vector<std::uint8_t>& fixed) {
  for (std::size_t row = 0; row < row_count(); ++row) {
    for (std::uint32_t k = begin_[row]; k < begin_[row + 1]; ++k) {
      for (std::size_t j = 0; j < 3; ++j) {
        for (std::size_t i = 0; i < 3; ++i) {
          if (fixed[3 * row + i] != 0 || fixed[3 * std::size_t{columns_[k]} + j] != 0) {
            block(k)[3 * j + i] = 0.0f;
          }
        }
      }
    }
  }
}

bool BlockRows::finish(float shift) {
  for (std::size_t row = 0; row < row_count(); ++row) {
    Eigen::Map<Eigen::Matrix3f> diagonal(block(diagonal_[row]));
    for (int i = 0; i < 3; ++i) {
      float& value = diagonal(i, i);
      value = value == 0.0f ? 1.0f : value + shift;
    }
    const Eigen::LLT<Eigen::Matrix3f> factor(diagonal);
    if (factor.info() != Eigen::Success) return false;
    Eigen::Map<Eigen::Matrix3f> inverse(&inverse_diagonal_[9 * row]);
    inverse = factor.solve(Eigen::Matrix3f::Identity());
  }
  return true;
}

void BlockRows::multiply(const double* x, double* result) const {
  for (std::size_t row = 0; row < row_count(); ++row) {
    WideThree sum = {};
    for (std::uint32_t k = begin_[row]; k < begin_[row + 1]; ++k) {
      sum += times(block(k), x + 3 * std::size_t{columns_[k]});
    }
    std::memcpy(result + 3 * row, &sum, 3 * sizeof(double));
  }
}

void BlockRows::sweep_from_zero(const float* b, float* x) const {
  for (std::size_t row = 0; row < row_count(); ++row) {
    Three rest = load(b + 3 * row);
    for (std::uint32_t k = begin_[row]; k < diagonal_[row]; ++k) {
      rest -= times(block(k), x + 3 * std::size_t{columns_[k]});
    }
    float right[4];
    std::memcpy(right, &rest, sizeof right);
    store(times(&inverse_diagonal_[9 * row], right), x + 3 * row);
  }
}

void BlockRows::residual_after_sweep(const float* x, float* residual) const {
  for (std::size_t row = 0; row < row_count(); ++row) {
    Three rest = {};
    for (std::uint32_t k = diagonal_[row] + 1; k < begin_[row + 1]; ++k) {
      rest -= times(block(k), x + 3 * std::size_t{columns_[k]});
    }
    store(rest, residual + 3 * row);
  }
}

void BlockRows::sweep_back(const float* b, float* x) const {
  for (std::size_t row = row_count(); row-- > 0;) {
    Three rest = load(b + 3 * row);
    for (std::uint32_t k = begin_[row]; k < begin_[row + 1]; ++k) {
      if (k != diagonal_[row]) rest -= times(block(k), x + 3 * std::size_t{columns_[k]});
    }
    float right[4];
    std::memcpy(right, &rest, sizeof right);
    store(times(&inverse_diagonal_[9 * row], right), x + 3 * row);
  }
}

}  // namespace tissue
