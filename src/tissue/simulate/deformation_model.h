#pragma once

#include "effect_costs.h"

namespace tissue {

/// What turns poses into a state. Poses and time steps have been checked.
class DeformationModel {
 public:
  virtual ~DeformationModel() = default;
  virtual StepReport step(const ToolPoses& tools, double dt) = 0;
  virtual void reset() = 0;
  virtual bool recovering() const = 0;
  virtual const State& state() const = 0;
  /// Where places in the material are.
  virtual std::vector<Vec3> places(const std::vector<TetPlace>& material) const = 0;
  /// What closed_form has not, because it solves no equation.
  virtual std::vector<std::optional<Vec3>> tool_forces() const { return {}; }
  virtual std::vector<std::optional<ToolFeedback>> tool_feedback() const { return {}; }
  virtual std::vector<Vec3> anchor_forces() const { return {}; }
  virtual std::vector<TetStrain> strains() const { return {}; }
};

/// Where a place is if everything is linear in its tet.
inline Vec3 linear_place(const Body& body, const State& state, const TetPlace& place) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    sum += place.barycentric[i] * state.positions[body.tets[place.tet][i]];
  }
  return sum;
}

std::unique_ptr<DeformationModel> closed_form_model(const SceneDescription& scene, const Body& body,
                                                    EffectCosts& costs);
std::unique_ptr<DeformationModel> solid_model(const SceneDescription& scene, const Body& body,
                                              EffectCosts& costs, int threads);

}  // namespace tissue
