#include "deformation_model.h"
#include "held_nodes.h"
#include "linear_response.h"
#include "tissue/simulate/elastic_energy.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <utility>

namespace tissue {
namespace {

// A step that finds no equilibrium is tried again in halves, so often.
constexpr int kMaxHalvings = 4;

Constitution constitution_of(Model model) {
  switch (model) {
    case Model::kLinear: return Constitution::kLinear;
    case Model::kCorotational: return Constitution::kCorotational;
    default: return Constitution::kNeoHookean;
  }
}

Run run_on(int threads) {
  Run run;
  run.threads = threads;
  return run;
}

TetStrain tet_strain(Constitution constitution, const Lame& lame, const Mat3& f) {
  Mat3 cauchy = stress(constitution, lame, f);
  // Small strain does not tell Cauchy's stress from the first Piola-Kirchhoff stress.
  if (constitution != Constitution::kLinear) cauchy = cauchy * f.transpose() / f.determinant();
  const Mat3 deviator = cauchy - cauchy.trace() / 3.0 * Mat3::Identity();
  const Eigen::SelfAdjointEigenSolver<Mat3> stretches(f.transpose() * f, Eigen::EigenvaluesOnly);
  return {std::sqrt(1.5) * deviator.norm(), std::sqrt(stretches.eigenvalues()[2]) - 1.0};
}

// Tissue as a solid that is always at rest: each step finds the equilibrium under its weight, held
// by anchors and by what the tools have taken hold of.
class SolidModel : public DeformationModel {
 public:
  SolidModel(const SceneDescription& scene, const Body& body, EffectCosts& costs, int threads)
      : scene_(scene),
        body_(body),
        elements_(body, scene.element_order),
        lame_(lame_with_cost(scene, body, costs)),
        elastic_(elements_, lame_, constitution_of(scene.model), run_on(threads)),
        held_(elements_, scene.tools, scene.anchors.size(), held_by_anchors(body, scene.anchors)),
        rest_(rest_positions(elements_)),
        positions_(rest_) {
    std::vector<const Energy*> energies = {&elastic_};
    if (scene.has(Effect::kGravity)) {
      EffectCost* const cost = costs.of(Effect::kGravity);
      const CostClock clock(cost);
      gravity_.emplace(elements_, scene.material.mass_density, scene.gravity);
      cost->bytes = static_cast<std::size_t>(positions_.size()) * sizeof(double);
      energies.push_back(&*gravity_);
    }
    equilibrium_ = std::make_unique<Equilibrium>(std::move(energies), elastic_.empty_hessian(),
                                                 direct_solver(), scene.model == Model::kLinear);
    reset();
  }

  StepReport step(const ToolPoses& tools, double) override {
    const bool regrip = held_.update(tools, state_.positions);
    if (scene_.model == Model::kLinear && !regrip && settled_) {
      superpose(tools);
      return report_;
    }
    positions_ = positions_now();
    response_.reset();
    if (regrip) equilibrium_->hold(held_.flags());
    const Eigen::VectorXd motion = held_.motion_to(tools, positions_);
    if (regrip || !settled_ || !motion.isZero(0.0)) move(motion);
    last_tools_ = tools;
    return report_;
  }

  void reset() override {
    held_.release();
    equilibrium_->hold(held_.flags());
    response_.reset();
    positions_ = rest_;
    state_ = rest_state(body_);
    report_ = {};
    report_.energy = equilibrium_->energy(positions_);
    // Without a load, rest is the equilibrium.
    settled_ = !gravity_;
  }

  bool recovering() const override { return false; }
  const State& state() const override { return state_; }

  std::vector<std::optional<Vec3>> tool_forces() const override {
    const std::vector<Vec3> all = forces_on_holders();
    return {all.begin() + static_cast<std::ptrdiff_t>(scene_.anchors.size()), all.end()};
  }

  std::vector<Vec3> anchor_forces() const override {
    std::vector<Vec3> forces = forces_on_holders();
    forces.resize(scene_.anchors.size());
    return forces;
  }

  std::vector<TetStrain> strains() const override {
    std::vector<TetStrain> result(body_.tets.size());
    const Eigen::VectorXd positions = positions_now();
    for (std::size_t t = 0; t < result.size(); ++t) {
      for (const QuadraturePoint& point : elements_.quadrature()) {
        const TetStrain here = tet_strain(constitution_of(scene_.model), lame_[t],
                                          elastic_.deformation_gradient(t, point, positions));
        result[t].von_mises += point.weight * here.von_mises;
        result[t].largest_strain += point.weight * here.largest_strain;
      }
    }
    return result;
  }

 private:
  static std::vector<Lame> lame_with_cost(const SceneDescription& scene, const Body& body,
                                          EffectCosts& costs) {
    EffectCost* const cost = costs.of(Effect::kDensityResponse);
    const CostClock clock(cost);
    std::vector<Lame> result = lame_of(scene.material, body);
    if (cost != nullptr) cost->bytes = result.capacity() * sizeof(Lame);
    return result;
  }

  static std::vector<int> held_by_anchors(const Body& body, const std::vector<Anchor>& anchors) {
    std::vector<int> holders = anchors_of_vertices(body, anchors);
    require_held(body, holders);
    return holders;
  }

  std::vector<Vec3> forces_on_holders() const {
    return held_.forces(equilibrium_->gradient(positions_now()));
  }

  // How each tool has moved since the base: its translation, then R − I column by column.
  Eigen::VectorXd amounts_at(const ToolPoses& tools) const {
    Eigen::VectorXd amounts = Eigen::VectorXd::Zero(12 * static_cast<Eigen::Index>(tools.size()));
    for (std::size_t i = 0; i < tools.size(); ++i) {
      if (!tools[i] || !base_tools_[i]) continue;
      const auto k = 12 * static_cast<Eigen::Index>(i);
      amounts.segment<3>(k) = tools[i]->position - base_tools_[i]->position;
      // A tool that only moves costs one pass over the body, one that turns four.
      if (tools[i]->orientation.coeffs() == base_tools_[i]->orientation.coeffs()) continue;
      const Eigen::Quaterniond turn =
          tools[i]->orientation.normalized() * base_tools_[i]->orientation.normalized().conjugate();
      const Mat3 change = turn.toRotationMatrix() - Mat3::Identity();
      amounts.segment<9>(k + 3) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(change.data());
    }
    return amounts;
  }

  // Twelve motions for each tool, in the order of amounts_at(), from the poses of the step before,
  // with which what is held is at an equilibrium.
  void prepare_response() {
    base_tools_ = last_tools_;
    std::vector<Eigen::VectorXd> motions;
    for (std::size_t tool = 0; tool < base_tools_.size(); ++tool) {
      const Vec3 centre = base_tools_[tool] ? base_tools_[tool]->position : Vec3(Vec3::Zero());
      const auto add = [&](const std::function<Vec3(const Vec3&)>& motion_at) {
        motions.push_back(held_.motion_of(tool, positions_, centre, motion_at));
      };
      for (int axis = 0; axis < 3; ++axis) {
        add([&](const Vec3&) -> Vec3 { return Vec3::Unit(axis); });
      }
      for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
          add([&](const Vec3& offset) -> Vec3 { return offset[column] * Vec3::Unit(row); });
        }
      }
    }
    response_.emplace(*equilibrium_, positions_, motions);
  }

  // Small strain: where the tools go decides where everything goes, and nothing is solved.
  void superpose(const ToolPoses& tools) {
    if (!held_.any_grip()) return;
    if (!response_) prepare_response();
    amounts_ = amounts_at(tools);
    response_->superpose(amounts_, state_.positions);
    held_.place(tools, state_.positions);
    report_.iterations = 0;
    report_.energy = response_->energy(amounts_);
  }

  // Of all nodes, also after a superposition.
  Eigen::VectorXd positions_now() const {
    return response_ ? response_->superpose(amounts_) : positions_;
  }

  void move(const Eigen::VectorXd& motion) {
    const Eigen::VectorXd before = positions_;
    report_ = {};
    settled_ = advance(motion, kMaxHalvings) && positions_.allFinite();
    report_.not_converged = !settled_;
    if (!settled_) positions_ = before;
    take_state();
  }

  // Moves what is held by `motion` and lets the rest settle; in two halves where that fails.
  bool advance(const Eigen::VectorXd& motion, int halvings) {
    const Eigen::VectorXd before = positions_;
    if (!motion.isZero(0.0)) equilibrium_->follow(positions_, motion);
    const EquilibriumReport found = equilibrium_->solve(positions_, scene_.solver);
    report_.iterations += found.iterations;
    report_.residual = found.residual;
    report_.energy = found.energy;
    if (found.converged) return true;
    if (halvings == 0 || motion.isZero(0.0)) return false;
    positions_ = before;
    const Eigen::VectorXd half = 0.5 * motion;
    return advance(half, halvings - 1) && advance(motion - half, halvings - 1);
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
  std::vector<Lame> lame_;
  ElasticEnergy elastic_;
  std::optional<GravityEnergy> gravity_;
  HeldNodes held_;
  // Of all nodes.
  Eigen::VectorXd rest_, positions_;
  State state_;
  std::unique_ptr<Equilibrium> equilibrium_;
  // For small strain, while what the tools hold stays the same.
  std::optional<LinearResponse> response_;
  ToolPoses last_tools_, base_tools_;
  Eigen::VectorXd amounts_;
  StepReport report_;
  bool settled_ = true;
};

}  // namespace

std::unique_ptr<DeformationModel> solid_model(const SceneDescription& scene, const Body& body,
                                              EffectCosts& costs, int threads) {
  return std::make_unique<SolidModel>(scene, body, costs, threads);
}

}  // namespace tissue
