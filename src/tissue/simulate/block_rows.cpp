#include "block_rows.h"

#include "block_jacobi.h"

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

inline Three column(const float* from, float) { return load(from); }
inline WideThree column(const float* from, double) {
  return __builtin_convertvector(load(from), WideThree);
}

// A sum of blocks times vectors, column by column, so that additions need not wait for each other.
template <class Vector>
struct Sum {
  Vector columns[3] = {};
  template <class Scalar>
  void add(const float* block, const Scalar* x) {
    for (int j = 0; j < 3; ++j) columns[j] += column(block + 3 * j, x[j]) * x[j];
  }
  Vector total() const { return columns[0] + columns[1] + columns[2]; }
};

// What a row moves by, from what the others leave of b.
inline Three solve_row(const float* inverse, const float* b, const Three& others) {
  const Three rest = load(b) - others;
  float right[4];
  std::memcpy(right, &rest, sizeof right);
  return times(inverse, right);
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

bool BlockRows::invert_diagonal(const std::vector<std::uint8_t>& fixed, float hold) {
  for (std::size_t row = 0; row < row_count(); ++row) {
    const Eigen::Map<const Eigen::Matrix3f> own(block(diagonal_[row]));
    const auto inverse = inverse_of_free(own, &fixed[3 * row], hold);
    if (!inverse) return false;
    std::memcpy(&inverse_diagonal_[9 * row], inverse->data(), sizeof *inverse);
  }
  return true;
}

void BlockRows::multiply(const double* x, double* result) const {
  for (std::size_t row = 0; row < row_count(); ++row) {
    Sum<WideThree> sum;
    for (std::uint32_t k = begin_[row]; k < begin_[row + 1]; ++k) {
      sum.add(block(k), x + 3 * std::size_t{columns_[k]});
    }
    const WideThree total = sum.total();
    std::memcpy(result + 3 * row, &total, 3 * sizeof(double));
  }
}

void BlockRows::sweep_from_zero(const float* b, float* x) const {
  for (std::size_t row = 0; row < row_count(); ++row) {
    Sum<Three> sum;
    for (std::uint32_t k = begin_[row]; k < diagonal_[row]; ++k) {
      sum.add(block(k), x + 3 * std::size_t{columns_[k]});
    }
    store(solve_row(&inverse_diagonal_[9 * row], b + 3 * row, sum.total()), x + 3 * row);
  }
}

void BlockRows::residual_after_sweep(const float* x, float* residual) const {
  for (std::size_t row = 0; row < row_count(); ++row) {
    Sum<Three> sum;
    for (std::uint32_t k = diagonal_[row] + 1; k < begin_[row + 1]; ++k) {
      sum.add(block(k), x + 3 * std::size_t{columns_[k]});
    }
    store(-sum.total(), residual + 3 * row);
  }
}

void BlockRows::sweep_back(const float* b, float* x) const {
  for (std::size_t row = row_count(); row-- > 0;) {
    // Its own block as well: what the row is out of balance by is what it moves by.
    Sum<Three> sum;
    for (std::uint32_t k = begin_[row + 1]; k-- > begin_[row];) {
      sum.add(block(k), x + 3 * std::size_t{columns_[k]});
    }
    float* const own = x + 3 * row;
    store(load(own) + solve_row(&inverse_diagonal_[9 * row], b + 3 * row, sum.total()), own);
  }
}

}  // namespace tissue
