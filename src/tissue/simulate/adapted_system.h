#pragma once

#include "conjugate_gradients.h"
#include "tissue/simulate/linear_system.h"

#include <utility>

namespace tissue {

/// A system that adds something to another, its base, which preconditions conjugate gradients over
/// all of it.
class AdaptedSystem : public LinearSystem {
 public:
  /// `tolerance`: ‖b − A x‖ ≤ tolerance ‖b‖.
  AdaptedSystem(std::unique_ptr<LinearSystem> base, double tolerance)
      : base_(std::move(base)), tolerance_(tolerance) {}

  const char* name() const override { return base_->name(); }
  void set_zero() override { base_->set_zero(); }
  void add(std::uint32_t a, std::uint32_t b, const Mat3& block) override {
    base_->add(a, b, block);
  }
  void add_mass(const MassMatrix& mass, double factor) override { base_->add_mass(mass, factor); }
  void add_elements(std::size_t first_pack, const std::vector<MaterialTensor>& tensors) override {
    base_->add_elements(first_pack, tensors);
  }
  void add_squares(const SquareSum& squares) override { base_->add_squares(squares); }
  void finish() override { base_->finish(); }
  double largest_diagonal() const override { return base_->largest_diagonal(); }
  void multiply_add(const Eigen::VectorXd& x, Eigen::VectorXd& result) const override {
    base_->multiply_add(x, result);
  }
  bool precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) override {
    return base_->precondition(r, z);
  }

  bool prepare(const std::vector<std::uint8_t>& fixed, double shift) override {
    fixed_ = fixed;
    return prepare_base(fixed, shift);
  }

  bool solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) override {
    int iterations = iterate(b, x);
    if (iterations < 0 && !is_fresh_) {
      // What the base kept did not serve.
      forget();
      if (!prepare(std::vector<std::uint8_t>(fixed_), 0.0)) return false;
      iterations = iterate(b, x);
    }
    if (iterations < 0) return false;
    if (is_fresh_) fresh_iterations_ = iterations;
    is_fresh_ = false;
    if (iterations > 2 * fresh_iterations_ + 2) forget();
    return true;
  }

  void forget() override {
    is_fresh_ = true;
    base_->forget();
  }

 protected:
  LinearSystem& base() { return *base_; }
  const LinearSystem& base() const { return *base_; }
  /// Takes out of a vector what is not to be found.
  virtual void restrict(Eigen::VectorXd& vector) const {
    for (std::size_t i = 0; i < fixed_.size(); ++i) {
      if (fixed_[i] != 0) vector[static_cast<Eigen::Index>(i)] = 0.0;
    }
  }
  /// With what is fixed, and to the base besides.
  virtual bool prepare_base(const std::vector<std::uint8_t>& fixed, double shift) {
    return base_->prepare(fixed, shift);
  }

 private:
  int iterate(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
    Eigen::VectorXd right = b;
    restrict(right);
    return conjugate_gradients(
        right, tolerance_,
        [&](const Eigen::VectorXd& from, Eigen::VectorXd& product) {
          product.setZero(from.size());
          multiply_add(from, product);
          restrict(product);
        },
        [&](const Eigen::VectorXd& residual, Eigen::VectorXd& z) {
          if (!precondition(residual, z)) z.setZero(residual.size());
        },
        x);
  }

  std::unique_ptr<LinearSystem> base_;
  double tolerance_;
  std::vector<std::uint8_t> fixed_;
  bool is_fresh_ = true;
  int fresh_iterations_ = 0;
};

}  // namespace tissue
