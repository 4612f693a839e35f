#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace tissue {

/// The inverse of a node's block without the coordinates for which `fixed` is set, three flags; the
/// diagonal made larger by a part `hold` of itself, and to 1 where it is zero. Nothing unless the
/// block is positive definite.
std::optional<Eigen::Matrix3f> inverse_of_free(Eigen::Matrix3f block, const std::uint8_t* fixed,
                                               float hold);

/// Steps of Jacobi's by a matrix's blocks on the diagonal: x += ω D⁻¹ r, as long as converges.
class BlockJacobi {
 public:
  /// False unless all blocks are positive definite; `fixed` holds three flags for each.
  bool prepare(const std::vector<Eigen::Matrix3f>& diagonal,
               const std::vector<std::uint8_t>& fixed);
  /// Estimates the largest eigenvalue of D⁻¹ A by power iteration from where the last one ended, or
  /// from anew. `multiply(x)` gives A x. False if it is not a positive number.
  template <class Multiply>
  bool find_longest_step(const Multiply& multiply);
  void forget() { slowest_.resize(0); }

  void smooth(const Eigen::VectorXf& r, Eigen::VectorXf& x) const { x += step_ * divide(r); }

 private:
  // D⁻¹ r; zero at what is fixed.
  Eigen::VectorXf divide(const Eigen::VectorXf& r) const;
  void start_anew();

  std::vector<Eigen::Matrix3f> inverse_;
  // Where power iteration is.
  Eigen::VectorXf slowest_;
  float step_ = 1.0f;
};

template <class Multiply>
bool BlockJacobi::find_longest_step(const Multiply& multiply) {
  constexpr int kAtFirst = 20, kLater = 1;
  // Power iteration comes from below. Steps below 2 by the eigenvalue converge; long ones damp best
  // what coarser levels cannot show.
  constexpr float kSafety = 1.1f, kStep = 1.75f;
  const bool is_new = slowest_.size() != static_cast<Eigen::Index>(3 * inverse_.size());
  if (is_new) start_anew();
  float largest = 0.0f;
  for (int i = 0; i < (is_new ? kAtFirst : kLater); ++i) {
    slowest_ /= slowest_.norm();
    slowest_ = divide(multiply(slowest_));
    largest = slowest_.norm();
  }
  if (!(std::isfinite(largest) && largest > 0.0f)) {
    forget();
    return false;
  }
  step_ = kStep / (kSafety * largest);
  return true;
}

}  // namespace tissue
