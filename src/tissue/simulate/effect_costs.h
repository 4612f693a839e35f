#pragma once

#include "tissue/simulate/energy.h"
#include "tissue/simulate/scene.h"

#include <chrono>

namespace tissue {

/// Seconds and bytes of the effects that a scene names, and of no others.
class EffectCosts {
 public:
  /// `effects` must outlive this.
  explicit EffectCosts(const std::vector<Effect>& effects) : effects_(effects) {
    for (const Effect& effect : effects) costs_.push_back({effect.name(), 0.0, 0});
  }
  /// Of the effect with these parameters; nothing if the scene does not name it.
  template <class Options>
  EffectCost* of() {
    for (std::size_t i = 0; i < effects_.size(); ++i) {
      if (effects_[i].template options<Options>() != nullptr) return &costs_[i];
    }
    return nullptr;
  }
  /// Of one of the scene's effects, by its number.
  EffectCost& at(std::size_t effect) { return costs_[effect]; }
  const std::vector<EffectCost>& all() const { return costs_; }

 private:
  const std::vector<Effect>& effects_;
  std::vector<EffectCost> costs_;
};

/// Adds the time until its end to an effect's cost.
class CostClock {
 public:
  explicit CostClock(EffectCost* cost) : cost_(cost) {}
  ~CostClock() {
    if (cost_ == nullptr) return;
    cost_->seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  CostClock(const CostClock&) = delete;
  CostClock& operator=(const CostClock&) = delete;

 private:
  EffectCost* cost_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// An energy whose calls are counted as the cost of an effect. Both references must outlive this.
class CountedEnergy : public Energy {
 public:
  CountedEnergy(const Energy& energy, EffectCost* cost) : energy_(energy), cost_(cost) {}
  double evaluate(const Eigen::VectorXd& positions, Eigen::VectorXd* gradient,
                  Hessian* hessian) const override {
    const CostClock clock(cost_);
    return energy_.evaluate(positions, gradient, hessian);
  }

  bool is_penalty() const override { return energy_.is_penalty(); }

 private:
  const Energy& energy_;
  EffectCost* cost_;
};

}  // namespace tissue
