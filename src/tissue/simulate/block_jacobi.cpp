#include "block_jacobi.h"

#include <Eigen/Cholesky>

namespace tissue {

std::optional<Eigen::Matrix3f> inverse_of_free(Eigen::Matrix3f block, const std::uint8_t* fixed,
                                               float hold) {
  for (int i = 0; i < 3; ++i) {
    if (fixed[i] != 0) {
      block.row(i).setZero();
      block.col(i).setZero();
    }
    block(i, i) = block(i, i) == 0.0f ? 1.0f : (1.0f + hold) * block(i, i);
  }
  const Eigen::LLT<Eigen::Matrix3f> factor(block);
  if (factor.info() != Eigen::Success) return std::nullopt;
  Eigen::Matrix3f inverse = factor.solve(Eigen::Matrix3f::Identity());
  for (int i = 0; i < 3; ++i) {
    if (fixed[i] != 0) inverse(i, i) = 0.0f;
  }
  return inverse;
}

bool BlockJacobi::prepare(const std::vector<Eigen::Matrix3f>& diagonal,
                          const std::vector<std::uint8_t>& fixed) {
  inverse_.resize(diagonal.size());
  for (std::size_t node = 0; node < diagonal.size(); ++node) {
    const auto inverse = inverse_of_free(diagonal[node], &fixed[3 * node], 0.0f);
    if (!inverse) return false;
    inverse_[node] = *inverse;
  }
  return true;
}

Eigen::VectorXf BlockJacobi::divide(const Eigen::VectorXf& r) const {
  Eigen::VectorXf result(r.size());
  for (std::size_t node = 0; node < inverse_.size(); ++node) {
    const auto i = static_cast<Eigen::Index>(3 * node);
    result.segment<3>(i) = inverse_[node] * r.segment<3>(i);
  }
  return result;
}

// From signs without a pattern, so that no mode is left out, the same each time.
void BlockJacobi::start_anew() {
  slowest_.resize(static_cast<Eigen::Index>(3 * inverse_.size()));
  for (Eigen::Index i = 0; i < slowest_.size(); ++i) {
    slowest_[i] = (i * 7919) % 13 < 6 ? 1.0f : -1.0f;
  }
  slowest_ = divide(slowest_);
}

}  // namespace tissue
