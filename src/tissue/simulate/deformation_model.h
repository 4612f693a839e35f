#pragma once

#include "tissue/simulate/scene.h"

#include <chrono>

namespace tissue {

/// What turns poses into a state. Poses and time steps have been checked.
class DeformationModel {
 public:
  virtual ~DeformationModel() = default;
  virtual StepReport step(const ToolPoses& tools, double dt) = 0;
  virtual void reset() = 0;
  virtual bool recovering() const = 0;
  virtual const State& state() const = 0;
  /// What closed_form has not, because it solves no equation.
  virtual std::vector<std::optional<Vec3>> tool_forces() const { return {}; }
  virtual std::vector<Vec3> anchor_forces() const { return {}; }
  virtual std::vector<TetStrain> strains() const { return {}; }
};

/// Seconds and bytes of the effects that a scene names, and of no others.
class EffectCosts {
 public:
  explicit EffectCosts(const std::vector<Effect>& effects) : effects_(effects) {
    for (const Effect effect : effects) costs_.push_back({name(effect), 0.0, 0});
  }
  /// Nothing if the scene does not name the effect.
  EffectCost* of(Effect effect) {
    for (std::size_t i = 0; i < effects_.size(); ++i) {
      if (effects_[i] == effect) return &costs_[i];
    }
    return nullptr;
  }
  const std::vector<EffectCost>& all() const { return costs_; }

 private:
  std::vector<Effect> effects_;
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

std::unique_ptr<DeformationModel> closed_form_model(const SceneDescription& scene, const Body& body,
                                                    EffectCosts& costs);
std::unique_ptr<DeformationModel> solid_model(const SceneDescription& scene, const Body& body,
                                              EffectCosts& costs, int threads);

}  // namespace tissue
