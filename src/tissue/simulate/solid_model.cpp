#include "deformation_model.h"
#include "dynamics.h"
#include "effect_kind.h"
#include "solver_choice.h"
#include "tet_strains.h"
#include "tool_actions.h"
#include "tool_response.h"
#include "tissue/simulate/elastic_energy.h"
#include "tissue/simulate/spring_energy.h"

#include <algorithm>
#include <utility>

namespace tissue {
namespace {

// A step that finds no equilibrium is tried again in halves, so often.
constexpr int kMaxHalvings = 4;
// A way that is cut shorter than this is no way.
constexpr double kShortestStride = 1e-6;
// Tools that may not go all their way at once come to so many places in a step, at most.
constexpr int kMaxStrides = 16;

Run run_on(int threads) {
  Run run;
  run.threads = threads;
  return run;
}

// Tissue as a solid. Without inertia it is always at rest: each step finds the equilibrium under
// its loads, held by anchors and moved by tools; with it, it goes on in time.
class SolidModel : public DeformationModel {
 public:
  SolidModel(const SceneDescription& scene, const Body& body, EffectCosts& costs, int threads)
      : scene_(scene),
        body_(body),
        inclusions_(inclusions_of(scene, body)),
        soft_body_(inclusions_.empty() ? Body() : inclusions_.soft_part(body)),
        elements_(elastic_body(), scene.element_order, inclusions_.tets),
        young_(young_of(scene.material, elastic_body())),
        held_(elements_, scene.tools, scene.anchors.size(), held_by_anchors(body, scene),
              inclusions_.vertices),
        rest_(rest_positions(elements_)),
        positions_(rest_) {
    make_tissue(costs, threads);
    potentials_ = {tissue_.get()};
    if (SoftHolds::are_in(scene)) {
      soft_.emplace(scene, elements_, elastic_body());
      add_part(*soft_, nullptr);
    }
    for (std::size_t i = 0; i < scene.effects.size(); ++i) make_effect(i, costs.at(i));
    if (!inclusions_.empty()) {
      motions_.emplace(inclusions_, elements_, scene.model == Model::kLinear);
      needs_.motions = &*motions_;
    }
    std::vector<const Energy*> energies = potentials_;
    if (scene.has<InertiaOptions>()) {
      dynamics_ = std::make_unique<Dynamics>(scene, elements_, *tissue_, costs);
      for (const Energy* energy : dynamics_->energies()) energies.push_back(energy);
    }
    equilibrium_ = equilibrium_for(scene, elements_, std::move(energies), needs_, run_on(threads));
    actions_.emplace(scene.tools, held_, parts_);
    reset();
  }

  StepReport step(const ToolPoses& tools, double dt) override {
    const bool changes = actions_->take(tools, state_.positions, positions_now());
    if (actions_->regrips()) equilibrium_->hold(held_.flags());
    const bool is_linear = needs_.is_quadratic && !dynamics_,
               keeps = is_linear && !changes && settled_;
    if (dynamics_) {
      if (dt > 0.0) swing(tools, dt);
    } else if (keeps && !(soft_ && soft_->any_pad())) {
      superpose(tools);
    } else {
      settle(tools, changes);
    }
    if (!dynamics_ || dt > 0.0) finish(tools, keeps);
    return report_;
  }

  void reset() override {
    for (const ToolActions::Part& part : parts_) part.effect->reset();
    actions_->release();
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
    settled_ = std::none_of(parts_.begin(), parts_.end(),
                            [](const ToolActions::Part& part) { return part.effect->loads(); });
  }

  bool recovering() const override { return dynamics_ && dynamics_->moving(); }
  const State& state() const override { return state_; }

  std::vector<Vec3> places(const Body& body, const std::vector<TetPlace>& material) const override {
    const Eigen::VectorXd nodes = positions_now();
    // As if all was linear, which is right where it is rigid.
    std::vector<Vec3> result = DeformationModel::places(body, material);
    for (std::size_t i = 0; i < material.size(); ++i) {
      const std::optional<std::size_t> element = element_of(material[i].tet);
      if (element) result[i] = elements_.value_at(*element, material[i].barycentric, nodes);
    }
    return result;
  }

  std::vector<std::optional<Vec3>> tool_forces() const override {
    const Eigen::VectorXd positions = positions_now();
    const std::vector<Vec3> all = forces_on_holders(positions);
    std::vector<std::optional<Vec3>> forces(
        all.begin() + static_cast<std::ptrdiff_t>(scene_.anchors.size()), all.end());
    for (std::size_t i = 0; i < forces.size(); ++i) {
      for (const ToolLink* link : links_) {
        if (link->acts_on(i)) *forces[i] += link->wrench(i, positions, Vec3::Zero()).force;
      }
    }
    return forces;
  }

  std::vector<std::optional<ToolFeedback>> tool_feedback() const override {
    for (const ToolActions::Part& part : parts_) {
      if (const auto* const feedback = part.effect->feedback()) return *feedback;
    }
    return {};
  }

  std::vector<Vec3> anchor_forces() const override {
    const Eigen::VectorXd positions = positions_now();
    std::vector<Vec3> forces = forces_on_holders(positions);
    forces.resize(scene_.anchors.size());
    if (soft_) soft_->add_anchor_forces(positions, forces);
    return forces;
  }

  // What is rigid has none, and nobody knows its stress.
  std::vector<TetStrain> strains() const override {
    if (elastic_ == nullptr) return {};
    const std::vector<TetStrain> soft = tet_strains(elements_, *elastic_, positions_now());
    std::vector<TetStrain> result(body_.tets.size(), TetStrain{0.0, 0.0, 1.0});
    for (std::size_t t = 0; t < result.size(); ++t) {
      if (const std::optional<std::size_t> element = element_of(t)) result[t] = soft[*element];
    }
    return result;
  }

 private:
  void make_tissue(EffectCosts& costs, int threads) {
    EffectCost* const cost = costs.of<DensityResponseOptions>();
    const CostClock clock(cost);
    std::size_t bytes = 0;
    if (scene_.model == Model::kMassSpring) {
      tissue_ = std::make_unique<SpringEnergy>(elements_, young_);
    } else {
      auto elastic = std::make_unique<ElasticEnergy>(
          elements_, local_lame(), constitution_of(scene_.model), run_on(threads));
      bytes = elastic->bytes();
      elastic_ = elastic.get();
      tissue_ = std::move(elastic);
    }
    needs_.is_quadratic = scene_.model == Model::kLinear;
    if (cost != nullptr) cost->bytes = bytes;
  }

  std::vector<Lame> local_lame() const {
    std::vector<Lame> lame = lame_of(scene_.material, elastic_body());
    for (const Effect& effect : scene_.effects) {
      if (effect.kind().local_part != nullptr) lame = effect.kind().local_part(std::move(lame));
    }
    return lame;
  }

  void make_effect(std::size_t number, EffectCost& cost) {
    const Effect& effect = scene_.effects[number];
    if (effect.kind().make == nullptr) return;
    const CostClock clock(&cost);
    effects_.push_back(effect.kind().make(effect, {scene_, elastic_body(), elements_, young_}));
    cost.bytes = effects_.back()->bytes();
    add_part(*effects_.back(), &cost);
  }

  void add_part(SolidEffect& effect, EffectCost* cost) {
    parts_.push_back({&effect, cost});
    if (const Energy* const energy = effect.energy()) {
      counted_.push_back(std::make_unique<CountedEnergy>(*energy, cost));
      potentials_.push_back(counted_.back().get());
      needs_.is_quadratic = needs_.is_quadratic && effect.is_quadratic();
      needs_.adds_squares = needs_.adds_squares || effect.adds_squares();
    }
    if (effect.link() != nullptr) links_.push_back(effect.link());
  }

  static RigidInclusions inclusions_of(const SceneDescription& scene, const Body& body) {
    const auto* const options = scene.find<RigidInclusionsOptions>();
    return options == nullptr ? RigidInclusions() : RigidInclusions(body, options->density_above);
  }
  // Nothing for a tet that is rigid.
  std::optional<std::size_t> element_of(std::size_t tet) const {
    return inclusions_.empty() ? tet : inclusions_.element_of(tet);
  }
  const Body& elastic_body() const { return inclusions_.empty() ? body_ : soft_body_; }

  static std::vector<int> held_by_anchors(const Body& body, const SceneDescription& scene) {
    std::vector<int> holders = anchors_of_vertices(body, scene.anchors);
    // What has inertia may fly.
    if (!scene.has<InertiaOptions>()) require_held(body, holders, beds_of(body, scene.anchors));
    return holders;
  }

  double potential_energy() const {
    double sum = 0.0;
    for (const Energy* energy : potentials_) sum += energy->value(positions_);
    return sum;
  }

  // Anchors first, then tools, of what they hold.
  std::vector<Vec3> forces_on_holders(const Eigen::VectorXd& positions) const {
    return held_.forces(equilibrium_->gradient(positions));
  }

  // Finds the equilibrium with the tools where they are, or as far on their way as there is one.
  void settle(const ToolPoses& tools, bool changes) {
    positions_ = positions_now();
    response_.reset();
    bool must_solve = changes || !settled_;
    const StepReport before = std::exchange(report_, {});
    bool has_solved = false;
    settled_ = true;
    double part = 0.0;
    for (int stride = 0; stride < kMaxStrides && part < 1.0 && settled_; ++stride) {
      part = actions_->stride(tools, positions_);
      if (part < kShortestStride) break;
      settled_ =
          advance(between(actions_->reached(), tools, part), must_solve, kMaxHalvings, has_solved);
      must_solve = false;
    }
    if (!has_solved) {
      // Nothing moved that tissue feels.
      report_.energy = before.energy;
      report_.solver = before.solver;
    }
    report_.not_converged = !settled_;
    if (!settled_) report_.energy = potential_energy();
    take_state();
  }

  // Small strain: where the tools go decides where everything goes, and nothing is solved.
  void superpose(const ToolPoses& tools) {
    if (!held_.any_grip()) return;
    if (!response_) response_.emplace(*equilibrium_, held_, positions_, actions_->reached());
    response_->follow(tools, state_.positions);
    held_.place(tools, state_.positions);
    actions_->set_reached(tools);
    report_.iterations = 0;
    report_.energy = response_->energy();
  }

  // Of all nodes, also after a superposition.
  Eigen::VectorXd positions_now() const { return response_ ? response_->positions() : positions_; }

  // Goes on in time while the tools move to where they are.
  void swing(const ToolPoses& tools, double dt) {
    const EquilibriumReport found =
        dynamics_->advance(*equilibrium_, *actions_, tools, dt, positions_);
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

  // Moves the tools there and lets the rest settle; in two halves where that fails. If the second
  // fails, the tools stay where the first took them.
  bool advance(const ToolPoses& tools, bool must_solve, int halvings, bool& has_solved) {
    const Eigen::VectorXd before = positions_;
    const ToolPoses tools_before = actions_->reached();
    const Eigen::VectorXd motion = actions_->follow(tools, positions_);
    const bool moves = !motion.isZero(0.0);
    if (!moves && !actions_->changed() && !must_solve) return true;
    has_solved = true;
    if (moves) equilibrium_->follow(positions_, motion);
    if (solve()) return true;
    actions_->follow(tools_before, before);
    positions_ = before;
    if (halvings == 0 || !(moves || actions_->changed())) return false;
    return advance(between(tools_before, tools, 0.5), must_solve, halvings - 1, has_solved) &&
           advance(tools, false, halvings - 1, has_solved);
  }

  bool solve() {
    EquilibriumReport found;
    do {
      found = equilibrium_->solve(positions_, scene_.solver);
      report_.iterations += found.iterations;
    } while (found.converged && actions_->refine(positions_));
    report_.residual = found.residual;
    report_.solver = equilibrium_->solver_name();
    report_.energy = found.energy;
    return found.converged && positions_.allFinite() && actions_->accepts(positions_);
  }

  void finish(const ToolPoses& tools, bool is_superposed) {
    const Eigen::VectorXd positions = positions_now();
    const SolidView view = {tools, positions, *equilibrium_, held_, links_, is_superposed};
    for (const ToolActions::Part& part : parts_) {
      const CostClock clock(part.cost);
      part.effect->after_step(view);
      part.effect->report(report_);
      if (part.cost != nullptr) part.cost->bytes = part.effect->bytes();
    }
  }

  void take_state() {
    report_.unknowns = equilibrium_->unknowns();
    report_.moved_vertices = 0;
    for (std::size_t v = 0; v < body_.rest.size(); ++v) {
      const auto i = static_cast<Eigen::Index>(3 * v);
      state_.positions[v] = positions_.segment<3>(i);
      report_.moved_vertices += state_.positions[v] != Vec3(rest_.segment<3>(i));
    }
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
  // Soft holds and effects, their energies and links.
  std::vector<ToolActions::Part> parts_;
  std::vector<std::unique_ptr<CountedEnergy>> counted_;
  std::vector<const ToolLink*> links_;
  // All energies but those of inertia and damping, and what they ask of a linear system.
  std::vector<const Energy*> potentials_;
  SystemNeeds needs_;
  std::unique_ptr<Dynamics> dynamics_;
  // Of all nodes.
  Eigen::VectorXd rest_, positions_;
  State state_;
  std::unique_ptr<Equilibrium> equilibrium_;
  std::optional<ToolActions> actions_;
  // For small strain, while what the tools hold stays the same.
  std::optional<ToolResponse> response_;
  StepReport report_;
  bool settled_ = true;
};

}  // namespace

std::unique_ptr<DeformationModel> solid_model(const SceneDescription& scene, const Body& body,
                                              EffectCosts& costs, int threads) {
  return std::make_unique<SolidModel>(scene, body, costs, threads);
}

}  // namespace tissue
