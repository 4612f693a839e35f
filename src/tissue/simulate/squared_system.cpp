#include "squared_system.h"

#include "conjugate_gradients.h"

#include <utility>

namespace tissue {
namespace {

class SquaredSystem : public LinearSystem {
 public:
  SquaredSystem(std::unique_ptr<LinearSystem> base, double tolerance)
      : base_(std::move(base)), tolerance_(tolerance) {}

  const char* name() const override { return base_->name(); }
  void set_zero() override {
    base_->set_zero();
    squares_.clear();
  }
  void add(std::uint32_t a, std::uint32_t b, const Mat3& block) override {
    base_->add(a, b, block);
  }
  void add_mass(const MassMatrix& mass, double factor) override { base_->add_mass(mass, factor); }
  void add_elements(std::size_t first_pack, const std::vector<MaterialTensor>& tensors) override {
    base_->add_elements(first_pack, tensors);
  }
  void add_squares(const SquareSum& squares) override { squares_.push_back(squares); }
  void finish() override { base_->finish(); }
  double largest_diagonal() const override { return base_->largest_diagonal(); }

  void multiply_add(const Eigen::VectorXd& x, Eigen::VectorXd& result) const override {
    base_->multiply_add(x, result);
    for (const SquareSum& one : squares_) one.multiply_add(x, result);
  }
  bool prepare(const std::vector<std::uint8_t>& fixed, double shift) override {
    fixed_ = fixed;
    base_->forget();
    return base_->prepare(fixed, shift);
  }
  bool precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) override {
    return base_->precondition(r, z);
  }

  bool solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) override {
    Eigen::VectorXd right = b;
    clear_fixed(right);
    return conjugate_gradients(
               right, tolerance_,
               [&](const Eigen::VectorXd& from, Eigen::VectorXd& product) {
                 product.setZero(from.size());
                 multiply_add(from, product);
                 clear_fixed(product);
               },
               [&](const Eigen::VectorXd& residual, Eigen::VectorXd& z) {
                 if (!base_->precondition(residual, z)) z.setZero(residual.size());
               },
               x) >= 0;
  }
  void forget() override { base_->forget(); }

 private:
  void clear_fixed(Eigen::VectorXd& vector) const {
    for (std::size_t i = 0; i < fixed_.size(); ++i) {
      if (fixed_[i] != 0) vector[static_cast<Eigen::Index>(i)] = 0.0;
    }
  }

  std::unique_ptr<LinearSystem> base_;
  double tolerance_;
  std::vector<SquareSum> squares_;
  std::vector<std::uint8_t> fixed_;
};

}  // namespace

std::unique_ptr<LinearSystem> squared_system(std::unique_ptr<LinearSystem> base, double tolerance) {
  return std::make_unique<SquaredSystem>(std::move(base), tolerance);
}

}  // namespace tissue
