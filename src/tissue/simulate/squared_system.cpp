#include "squared_system.h"

#include "adapted_system.h"

#include <utility>

namespace tissue {
namespace {

class SquaredSystem : public AdaptedSystem {
 public:
  SquaredSystem(std::unique_ptr<LinearSystem> base, double tolerance, EffectCost& cost)
      : AdaptedSystem(std::move(base), tolerance), cost_(cost) {}

  void set_zero() override {
    AdaptedSystem::set_zero();
    squares_.clear();
  }
  void add_squares(const SquareSum& squares) override { squares_.push_back(squares); }
  void multiply_add(const Eigen::VectorXd& x, Eigen::VectorXd& result) const override {
    AdaptedSystem::multiply_add(x, result);
    const CostClock clock(&cost_);
    for (const SquareSum& one : squares_) one.multiply_add(x, result);
  }

 private:
  std::vector<SquareSum> squares_;
  EffectCost& cost_;
};

}  // namespace

std::unique_ptr<LinearSystem> squared_system(std::unique_ptr<LinearSystem> base, double tolerance,
                                             EffectCost& cost) {
  return std::make_unique<SquaredSystem>(std::move(base), tolerance, cost);
}

}  // namespace tissue
