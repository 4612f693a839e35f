#include "deformation_model.h"
#include "dynamics.h"
#include "force_feedback.h"
#include "held_nodes.h"
#include "soft_holds.h"
#include "solver_choice.h"
#include "tet_strains.h"
#include "tool_response.h"
#include "tissue/simulate/elastic_energy.h"
#include "tissue/simulate/gravity.h"
#include "tissue/simulate/spring_energy.h"

#include <algorithm>
#include <utility>

namespace tissue {
namespace {

// A step that finds no equilibrium is tried again in halves, so often.
constexpr int kMaxHalvings = 4;

Run run_on(int threads) {
  Run run;
  run.threads = threads;
  return run;
}

// Tissue as a solid that is always at rest: each step finds the equilibrium under its weight, held
// by anchors and by what the tools have taken hold of.
class SolidModel : public DeformationModel {
 public:
  SolidModel(const SceneDescription& scene, const Body& body, EffectCosts& costs, int threads)
      : scene_(scene),
        body_(body),
        elements_(body, scene.element_order),
        held_(elements_, scene.tools, scene.anchors.size(), held_by_anchors(body, scene)),
        rest_(rest_positions(elements_)),
        positions_(rest_) {
    make_tissue(costs, threads);
    potentials_ = {tissue_.get()};
    if (EffectCost* const cost = costs.of(Effect::kGravity)) {
      const CostClock clock(cost);
      gravity_.emplace(elements_, scene.material.mass_density, scene.gravity);
      counted_gravity_.emplace(*gravity_, cost);
      cost->bytes = gravity_->bytes();
      potentials_.push_back(&*counted_gravity_);
    }
    if (SoftHolds::are_in(scene)) {
      soft_.emplace(scene, elements_, body);
      potentials_.push_back(&soft_->energy());
    }
    std::vector<const Energy*> energies = potentials_;
    if (scene.has(Effect::kInertia)) {
      dynamics_ = std::make_unique<Dynamics>(scene, elements_, *tissue_, costs);
      for (const Energy* energy : dynamics_->energies()) energies.push_back(energy);
    }
    equilibrium_ = equilibrium_for(scene, elements_, std::move(energies), run_on(threads));
    if (EffectCost* const cost = costs.of(Effect::kForceFeedback)) {
      feedback_.emplace(held_, soft_ ? &*soft_ : nullptr, *equilibrium_, cost);
    }
    reset();
  }

  StepReport step(const ToolPoses& tools, double dt) override {
    bool regrip = held_.update(tools, state_.positions);
    if (soft_) regrip = soft_->update(tools, positions_now()) || regrip;
    const bool is_linear = scene_.model == Model::kLinear && !dynamics_;
    if (dynamics_) {
      if (regrip) equilibrium_->hold(held_.flags());
      if (soft_) soft_->move(soft_->motion_to(tools));
      if (dt > 0.0) swing(tools, dt);
    } else if (is_linear && !(soft_ && soft_->any_pad()) && !regrip && settled_) {
      superpose(tools);
    } else {
      settle(tools, regrip);
    }
    if (feedback_ && (!dynamics_ || dt > 0.0)) {
      feedback_->update(tools, positions_now(), is_linear && !regrip);
    }
    return report_;
  }

  void reset() override {
    held_.release();
    if (soft_) soft_->release();
    if (feedback_) feedback_->reset();
    equilibrium_->hold(held_.flags());
    response_.reset();
    positions_ = rest_;
    state_ = rest_state(body_);
    report_ = {};
    if (dynamics_) {
      dynamics_->reset();
      state_.velocities.assign(body_.rest.size(), Vec3::Zero());
    }
    report_.energy = potential_energy();
    // Without a load, rest is the equilibrium.
    settled_ = !gravity_;
  }

  bool recovering() const override { return dynamics_ && dynamics_->moving(); }
  const State& state() const override { return state_; }

  std::vector<Vec3> places(const Body&, const std::vector<TetPlace>& material) const override {
    const Eigen::VectorXd nodes = positions_now();
    std::vector<Vec3> result;
    for (const TetPlace& place : material) {
      result.push_back(elements_.value_at(place.tet, place.barycentric, nodes));
    }
    return result;
  }

  std::vector<std::optional<Vec3>> tool_forces() const override {
    const std::vector<Vec3> all = forces_on_holders();
    return {all.begin() + static_cast<std::ptrdiff_t>(scene_.anchors.size()), all.end()};
  }

  std::vector<std::optional<ToolFeedback>> tool_feedback() const override {
    return feedback_ ? feedback_->tools() : std::vector<std::optional<ToolFeedback>>();
  }

  std::vector<Vec3> anchor_forces() const override {
    std::vector<Vec3> forces = forces_on_holders();
    forces.resize(scene_.anchors.size());
    return forces;
  }

  std::vector<TetStrain> strains() const override {
    return elastic_ ? tet_strains(elements_, *elastic_, positions_now()) : std::vector<TetStrain>();
  }

 private:
  // Of held nodes, and of the tools' ends of pads.
  struct Motion {
    Eigen::VectorXd nodes, pads;
    bool is_zero() const { return nodes.isZero(0.0) && pads.isZero(0.0); }
  };

  void make_tissue(EffectCosts& costs, int threads) {
    EffectCost* const cost = costs.of(Effect::kDensityResponse);
    const CostClock clock(cost);
    std::size_t bytes = 0;
    if (scene_.model == Model::kMassSpring) {
      const std::vector<double> young = young_of(scene_.material, body_);
      tissue_ = std::make_unique<SpringEnergy>(elements_, young);
    } else {
      auto elastic =
          std::make_unique<ElasticEnergy>(elements_, lame_of(scene_.material, body_),
                                          constitution_of(scene_.model), run_on(threads));
      bytes = elastic->bytes();
      elastic_ = elastic.get();
      tissue_ = std::move(elastic);
    }
    if (cost != nullptr) cost->bytes = bytes;
  }

  static std::vector<int> held_by_anchors(const Body& body, const SceneDescription& scene) {
    std::vector<int> holders = anchors_of_vertices(body, scene.anchors);
    // What has inertia may fly.
    if (!scene.has(Effect::kInertia)) require_held(body, holders, beds_of(body, scene.anchors));
    return holders;
  }

  double potential_energy() const {
    double sum = 0.0;
    for (const Energy* energy : potentials_) sum += energy->value(positions_);
    return sum;
  }

  std::vector<Vec3> forces_on_holders() const {
    const Eigen::VectorXd positions = positions_now();
    std::vector<Vec3> forces = held_.forces(equilibrium_->gradient(positions));
    if (soft_) soft_->add_forces(positions, forces);
    return forces;
  }

  // Finds the equilibrium with the tools where they are.
  void settle(const ToolPoses& tools, bool regrip) {
    positions_ = positions_now();
    response_.reset();
    if (regrip) equilibrium_->hold(held_.flags());
    Motion motion = {held_.motion_to(tools, positions_), {}};
    if (soft_) motion.pads = soft_->motion_to(tools);
    if (regrip || !settled_ || !motion.is_zero()) move(motion);
    last_tools_ = tools;
  }

  // Small strain: where the tools go decides where everything goes, and nothing is solved.
  void superpose(const ToolPoses& tools) {
    if (!held_.any_grip()) return;
    if (!response_) response_.emplace(*equilibrium_, held_, positions_, last_tools_);
    response_->follow(tools, state_.positions);
    held_.place(tools, state_.positions);
    report_.iterations = 0;
    report_.energy = response_->energy();
  }

  // Of all nodes, also after a superposition.
  Eigen::VectorXd positions_now() const { return response_ ? response_->positions() : positions_; }

  void move(const Motion& motion) {
    const Eigen::VectorXd before = positions_;
    report_ = {};
    settled_ = advance(motion, kMaxHalvings) && positions_.allFinite();
    report_.not_converged = !settled_;
    if (!settled_) positions_ = before;
    take_state();
  }

  // Goes on in time while the tools move to where they are.
  void swing(const ToolPoses& tools, double dt) {
    const EquilibriumReport found = dynamics_->advance(
        *equilibrium_,
        [&](const Eigen::VectorXd& positions) { return held_.motion_to(tools, positions); }, dt,
        positions_);
    report_ = {};
    report_.iterations = found.iterations;
    report_.residual = found.residual;
    report_.solver = equilibrium_->solver_name();
    report_.not_converged = !found.converged;
    report_.energy = (found.converged ? dynamics_->potential_energy() : potential_energy()) +
                     dynamics_->kinetic_energy();
    take_state();
    for (std::size_t v = 0; v < body_.rest.size(); ++v) {
      state_.velocities[v] = dynamics_->velocities().segment<3>(static_cast<Eigen::Index>(3 * v));
    }
  }

  // Moves what is held by `motion` and lets the rest settle; in two halves where that fails.
  bool advance(const Motion& motion, int halvings) {
    const Eigen::VectorXd before = positions_;
    if (!motion.nodes.isZero(0.0)) equilibrium_->follow(positions_, motion.nodes);
    if (soft_) soft_->move(motion.pads);
    const EquilibriumReport found = equilibrium_->solve(positions_, scene_.solver);
    report_.iterations += found.iterations;
    report_.residual = found.residual;
    report_.solver = equilibrium_->solver_name();
    report_.energy = found.energy;
    if (found.converged) return true;
    if (soft_) soft_->move(-motion.pads);
    if (halvings == 0 || motion.is_zero()) return false;
    positions_ = before;
    const Motion half = {0.5 * motion.nodes, 0.5 * motion.pads};
    return advance(half, halvings - 1) && advance(half, halvings - 1);
  }

  void take_state() {
    report_.moved_vertices = 0;
    for (std::size_t v = 0; v < body_.rest.size(); ++v) {
      const auto i = static_cast<Eigen::Index>(3 * v);
      state_.positions[v] = positions_.segment<3>(i);
      report_.moved_vertices += state_.positions[v] != Vec3(rest_.segment<3>(i));
    }
  }

  const SceneDescription& scene_;
  const Body& body_;
  FiniteElements elements_;
  HeldNodes held_;
  // What the tissue stores; as a solid, if it is one.
  std::unique_ptr<const Energy> tissue_;
  const ElasticEnergy* elastic_ = nullptr;
  std::optional<GravityEnergy> gravity_;
  std::optional<SoftHolds> soft_;
  std::optional<CountedEnergy> counted_gravity_;
  // Of all of them.
  std::vector<const Energy*> potentials_;
  std::unique_ptr<Dynamics> dynamics_;
  // Of all nodes.
  Eigen::VectorXd rest_, positions_;
  State state_;
  std::unique_ptr<Equilibrium> equilibrium_;
  std::optional<ForceFeedback> feedback_;
  // For small strain, while what the tools hold stays the same.
  std::optional<ToolResponse> response_;
  ToolPoses last_tools_;
  StepReport report_;
  bool settled_ = true;
};

}  // namespace

std::unique_ptr<DeformationModel> solid_model(const SceneDescription& scene, const Body& body,
                                              EffectCosts& costs, int threads) {
  return std::make_unique<SolidModel>(scene, body, costs, threads);
}

}  // namespace tissue
