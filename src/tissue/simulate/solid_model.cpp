#include "deformation_model.h"
#include "solid.h"
#include "tool_response.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tissue {
namespace {

// A step that finds no equilibrium is tried again in halves, so often.
constexpr int kMaxHalvings = 4;
// A way that is cut shorter than this is no way.
constexpr double kShortestStride = 1e-6;

// Tissue as a solid. Without inertia it is always at rest: each step finds the equilibrium under
// its loads, held by anchors and moved by tools; with it, it goes on in time.
class SolidModel : public DeformationModel {
 public:
  SolidModel(const SceneDescription& scene, const Body& body, EffectCosts& costs, int threads)
      : scene_(scene),
        body_(body),
        solid_(scene, body, costs, threads),
        actions_(solid_.actions()),
        equilibrium_(solid_.equilibrium()),
        dynamics_(solid_.dynamics()),
        rest_(rest_positions(solid_.elements())),
        positions_(rest_) {
    reset();
  }

  StepReport step(const ToolPoses& tools, double dt) override {
    const bool changes = actions_.take(tools, state_.positions, positions_now_);
    if (actions_.regrips()) equilibrium_.hold(solid_.held().flags());
    const bool is_linear = solid_.is_linear() && !dynamics_,
               keeps = is_linear && !changes && settled_;
    if (dynamics_) {
      if (dt > 0.0) swing(tools, dt);
    } else if (keeps && !solid_.has_pads()) {
      superpose(tools);
    } else {
      settle(tools, changes);
    }
    if (!dynamics_ || dt > 0.0) finish(tools, keeps);
    return report_;
  }

  void reset() override {
    for (const ToolActions::Part& part : solid_.parts()) part.effect->reset();
    actions_.release();
    equilibrium_.hold(solid_.held().flags());
    response_.reset();
    positions_ = rest_;
    state_ = rest_state(body_);
    report_ = {};
    if (dynamics_) {
      dynamics_->reset();
      state_.velocities.assign(body_.rest.size(), Vec3::Zero());
    }
    report_.energy = solid_.potential_energy(positions_);
    // Without a load, rest is the equilibrium.
    settled_ = std::none_of(solid_.parts().begin(), solid_.parts().end(),
                            [](const ToolActions::Part& part) { return part.effect->loads(); });
  }

  bool recovering() const override { return dynamics_ && dynamics_->moving(); }
  const State& state() const override { return state_; }

  std::vector<NodeWeight> shape_at(const TetPlace& place) const override {
    return solid_.shape_at(place);
  }
  Vec3 node(std::uint32_t number) const override {
    if (number < state_.positions.size()) return state_.positions[number];
    return positions_now().segment<3>(3 * Eigen::Index{number});
  }
  std::vector<std::optional<Vec3>> tool_forces() const override {
    return solid_.tool_forces(positions_now());
  }
  std::vector<Vec3> anchor_forces() const override { return solid_.anchor_forces(positions_now()); }
  std::vector<TetStrain> strains() const override { return solid_.strains(positions_now()); }
  std::vector<std::optional<ToolFeedback>> tool_feedback() const override {
    for (const ToolActions::Part& part : solid_.parts()) {
      if (const auto* const feedback = part.effect->feedback()) return *feedback;
    }
    return {};
  }

 private:
  // Finds the equilibrium with the tools where they are, or as far on their way as there is one.
  void settle(const ToolPoses& tools, bool changes) {
    if (response_) positions_ = response_->positions();
    response_.reset();
    bool must_solve = changes || !settled_;
    const StepReport before = std::exchange(report_, {});
    bool has_solved = false;
    settled_ = true;
    double part = 0.0;
    for (int stride = 0; stride < kMaxStrides && part < 1.0 && settled_; ++stride) {
      part = actions_.stride(tools, positions_);
      if (part < kShortestStride) break;
      settled_ =
          advance(between(actions_.reached(), tools, part), must_solve, kMaxHalvings, has_solved);
      must_solve = false;
    }
    if (!has_solved) {
      // Nothing moved that tissue feels.
      report_.energy = before.energy;
      report_.solver = before.solver;
    }
    report_.not_converged = !settled_;
    if (!settled_) report_.energy = solid_.potential_energy(positions_);
    take_state();
  }

  // Small strain: where the tools go decides where everything goes, and nothing is solved.
  void superpose(const ToolPoses& tools) {
    if (!solid_.held().any_grip()) return;
    if (!response_)
      response_.emplace(body_, equilibrium_, solid_.held(), positions_, actions_.reached());
    response_->follow(tools, state_.positions);
    superposed_.resize(0);
    solid_.held().place(tools, state_.positions);
    actions_.set_reached(tools);
    report_.iterations = 0;
    report_.residual = 0.0;
    report_.moved_vertices = response_->moved_vertices();
    report_.energy = response_->energy();
    report_.folded = response_->folds(state_.positions);
  }

  // Of all nodes, also after a superposition.
  const Eigen::VectorXd& positions_now() const {
    if (!response_) return positions_;
    if (superposed_.size() == 0) superposed_ = response_->positions();
    return superposed_;
  }

  // Goes on in time while the tools move to where they are.
  void swing(const ToolPoses& tools, double dt) {
    const EquilibriumReport found =
        dynamics_->advance(equilibrium_, actions_, tools, dt, positions_);
    report_ = {};
    report_.iterations = found.iterations;
    report_.residual = found.residual;
    report_.solver = equilibrium_.solver_name();
    report_.not_converged = !found.converged;
    report_.energy =
        (found.converged ? dynamics_->potential_energy() : solid_.potential_energy(positions_)) +
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
    const ToolPoses tools_before = actions_.reached();
    const Eigen::VectorXd motion = actions_.follow(tools, positions_);
    const bool moves = !motion.isZero(0.0);
    if (!moves && !actions_.changed() && !must_solve) return true;
    has_solved = true;
    if (moves) equilibrium_.follow(positions_, motion);
    if (solve()) return true;
    actions_.follow(tools_before, before);
    positions_ = before;
    if (halvings == 0 || !(moves || actions_.changed())) return false;
    return advance(between(tools_before, tools, 0.5), must_solve, halvings - 1, has_solved) &&
           advance(tools, false, halvings - 1, has_solved);
  }

  bool solve() {
    EquilibriumReport found;
    do {
      found = equilibrium_.solve(positions_, scene_.solver);
      report_.iterations += found.iterations;
    } while (found.converged && actions_.refine(positions_));
    report_.residual = found.residual;
    report_.solver = equilibrium_.solver_name();
    report_.energy = found.energy;
    return found.converged && std::isfinite(found.energy) && positions_.allFinite() &&
           actions_.accepts(positions_);
  }

  void finish(const ToolPoses& tools, bool is_superposed) {
    if (solid_.parts().empty()) return;
    const SolidView view = {tools,
                            positions_now_,
                            equilibrium_,
                            solid_.held(),
                            solid_.links(),
                            is_superposed,
                            response_ ? &*response_ : nullptr};
    for (const ToolActions::Part& part : solid_.parts()) {
      const CostClock clock(part.cost);
      part.effect->after_step(view);
      part.effect->report(report_);
      if (part.cost != nullptr) part.cost->bytes = part.effect->bytes();
    }
  }

  void take_state() {
    report_.unknowns = equilibrium_.unknowns();
    report_.moved_vertices = 0;
    for (std::size_t v = 0; v < body_.rest.size(); ++v) {
      const auto i = static_cast<Eigen::Index>(3 * v);
      state_.positions[v] = positions_.segment<3>(i);
      report_.moved_vertices += state_.positions[v] != Vec3(rest_.segment<3>(i));
    }
    report_.folded = std::any_of(body_.tets.begin(), body_.tets.end(),
                                 [&](const Tet& tet) { return is_folded(tet, state_.positions); });
  }

  const SceneDescription& scene_;
  const Body& body_;
  Solid solid_;
  ToolActions& actions_;
  Equilibrium& equilibrium_;
  // Nothing without inertia.
  Dynamics* dynamics_;
  // Of all nodes.
  Eigen::VectorXd rest_, positions_;
  State state_;
  // For small strain, while what the tools hold stays the same.
  std::optional<ToolResponse> response_;
  // By it, once somebody has asked.
  mutable Eigen::VectorXd superposed_;
  const PositionsNow positions_now_ = [this]() -> const Eigen::VectorXd& {
    return positions_now();
  };
  StepReport report_;
  bool settled_ = true;
};

}  // namespace

std::unique_ptr<DeformationModel> solid_model(const SceneDescription& scene, const Body& body,
                                              EffectCosts& costs, int threads) {
  return std::make_unique<SolidModel>(scene, body, costs, threads);
}

}  // namespace tissue
