#pragma once

#include "dynamics.h"
#include "effect_kind.h"
#include "solver_choice.h"
#include "tool_actions.h"
#include "tissue/simulate/elastic_energy.h"

namespace tissue {

/// A body as a solid with everything that a scene adds to it: what does not change from step to
/// step.
class Solid {
 public:
  /// References must outlive this. Throws as Scene does.
  Solid(const SceneDescription& scene, const Body& body, EffectCosts& costs, int threads);
  Solid(const Solid&) = delete;
  Solid& operator=(const Solid&) = delete;

  const FiniteElements& elements() const { return elements_; }
  HeldNodes& held() { return held_; }
  Equilibrium& equilibrium() { return *equilibrium_; }
  ToolActions& actions() { return *actions_; }
  /// Nothing without inertia.
  Dynamics* dynamics() { return dynamics_.get(); }
  const Dynamics* dynamics() const { return dynamics_.get(); }
  /// Soft holds and effects.
  const std::vector<ToolActions::Part>& parts() const { return parts_; }
  const std::vector<const ToolLink*>& links() const { return links_; }
  /// Whether all forces are linear in the positions.
  bool is_linear() const { return needs_.is_quadratic; }
  bool has_pads() const { return soft_ && soft_->any_pad(); }

  /// Of the body and its loads, with nodes there [J].
  double potential_energy(const Eigen::VectorXd& positions) const;
  std::vector<NodeWeight> shape_at(const TetPlace& place) const;
  /// None for springs. What is rigid has none, and nobody knows its stress.
  std::vector<TetStrain> strains(const Eigen::VectorXd& positions) const;
  /// Of the tissue on each [N].
  std::vector<std::optional<Vec3>> tool_forces(const Eigen::VectorXd& positions) const;
  std::vector<Vec3> anchor_forces(const Eigen::VectorXd& positions) const;

 private:
  void make_tissue(EffectCosts& costs, int threads);
  std::vector<Lame> local_lame() const;
  void make_effect(std::size_t number, EffectCost& cost);
  void add_part(SolidEffect& effect, EffectCost* cost);
  // Nothing for a tet that is rigid.
  std::optional<std::size_t> element_of(std::size_t tet) const {
    return inclusions_.empty() ? tet : inclusions_.element_of(tet);
  }
  const Body& elastic_body() const { return inclusions_.empty() ? body_ : soft_body_; }
  // Anchors first, then tools, of what they hold.
  std::vector<Vec3> forces_on_holders(const Eigen::VectorXd& positions) const {
    return held_.forces(equilibrium_->gradient(positions));
  }

  const SceneDescription& scene_;
  const Body& body_;
  // What moves as rigid bodies, and what is left of the body without it, where there is any.
  RigidInclusions inclusions_;
  Body soft_body_;
  FiniteElements elements_;
  // Of each tet [Pa].
  std::vector<double> young_;
  std::optional<RigidMotions> motions_;
  HeldNodes held_;
  // What the tissue stores; as a solid, if it is one.
  std::unique_ptr<const Energy> tissue_;
  const ElasticEnergy* elastic_ = nullptr;
  std::optional<SoftHolds> soft_;
  std::vector<std::unique_ptr<SolidEffect>> effects_;
  std::vector<ToolActions::Part> parts_;
  std::vector<std::unique_ptr<CountedEnergy>> counted_;
  std::vector<const ToolLink*> links_;
  // All energies but those of inertia and damping, and what they ask of a linear system.
  std::vector<const Energy*> potentials_;
  SystemNeeds needs_;
  std::unique_ptr<Dynamics> dynamics_;
  std::unique_ptr<Equilibrium> equilibrium_;
  std::optional<ToolActions> actions_;
};

}  // namespace tissue
