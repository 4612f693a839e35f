#include "squared_system.h"

#include "adapted_system.h"

#include <utility>

namespace tissue {
namespace {

class SquaredSystem : public AdaptedSystem {
 public:
  using AdaptedSystem::AdaptedSystem;

  void set_zero() override {
    AdaptedSystem::set_zero();
    squares_.clear();
  }
  void add_squares(const SquareSum& squares) override { squares_.push_back(squares); }
  void multiply_add(const Eigen::VectorXd& x, Eigen::VectorXd& result) const override {
    AdaptedSystem::multiply_add(x, result);
    for (const SquareSum& one : squares_) one.multiply_add(x, result);
  }

 private:
  std::vector<SquareSum> squares_;
};

}  // namespace

std::unique_ptr<LinearSystem> squared_system(std::unique_ptr<LinearSystem> base, double tolerance) {
  return std::make_unique<SquaredSystem>(std::move(base), tolerance);
}

}  // namespace tissue
