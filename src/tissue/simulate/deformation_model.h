#pragma once

#include "effect_costs.h"
#include "tissue/simulate/finite_elements.h"

namespace tissue {

/// What turns poses into a state. Poses and time steps have been checked.
class DeformationModel {
 public:
  virtual ~DeformationModel() = default;
  virtual StepReport step(const ToolPoses& tools, double dt) = 0;
  virtual void reset() = 0;
  virtual bool recovering() const = 0;
  virtual const State& state() const = 0;
  /// The nodes on which a place in the material depends. The first are the body's vertices.
  virtual std::vector<NodeWeight> shape_at(const TetPlace& place) const = 0;
  /// Where a node is now [m].
  virtual Vec3 node(std::uint32_t number) const = 0;
  Vec3 mean_of(const std::vector<NodeWeight>& weights) const {
    Vec3 sum = Vec3::Zero();
    for (const NodeWeight& of : weights) sum += of.weight * node(of.node);
    return sum;
  }
  /// What closed_form has not, because it solves no equation.
  virtual std::vector<std::optional<Vec3>> tool_forces() const { return {}; }
  virtual std::vector<std::optional<ToolFeedback>> tool_feedback() const { return {}; }
  virtual std::vector<Vec3> anchor_forces() const { return {}; }
  virtual std::vector<TetStrain> strains() const { return {}; }
};

/// The shape functions of a tet that is linear.
inline std::vector<NodeWeight> linear_shape(const Tet& tet, const TetPlace& place) {
  std::vector<NodeWeight> shape;
  for (std::size_t i = 0; i < 4; ++i) shape.push_back({tet[i], place.barycentric[i]});
  return shape;
}

std::unique_ptr<DeformationModel> closed_form_model(const SceneDescription& scene, const Body& body,
                                                    EffectCosts& costs);
std::unique_ptr<DeformationModel> solid_model(const SceneDescription& scene, const Body& body,
                                              EffectCosts& costs, int threads);

}  // namespace tissue
