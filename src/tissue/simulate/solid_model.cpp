#include "deformation_model.h"
#include "grip.h"
#include "tissue/simulate/elastic_energy.h"

#include <Eigen/Eigenvalues>

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
        anchored_(anchored_vertices(body, scene.anchors)),
        rest_(rest_positions(elements_)),
        positions_(rest_),
        grips_(scene.tools.size()) {
    require_held(body, anchored_);
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
    put_to_rest();
  }

  StepReport step(const ToolPoses& tools, double) override {
    for (std::size_t i = 0; i < tools.size(); ++i) {
      if (!grips_[i].update(tools[i], scene_.tools[i], state_.positions, taken_)) continue;
      regrip_ = true;
      find_taken();
    }
    if (regrip_) equilibrium_->hold(held_nodes());
    const Eigen::VectorXd motion = motion_to(tools);
    if (regrip_ || !settled_ || !motion.isZero(0.0)) move(motion);
    regrip_ = false;
    return report_;
  }

  void reset() override { put_to_rest(); }
  bool recovering() const override { return false; }
  const State& state() const override { return state_; }

  std::vector<std::optional<Vec3>> tool_forces() const override {
    const Eigen::VectorXd gradient = equilibrium_->gradient(positions_);
    std::vector<std::optional<Vec3>> forces;
    for (const Grip& grip : grips_) {
      Vec3 sum = Vec3::Zero();
      for (const std::uint32_t v : grip.vertices()) sum -= node(gradient, v);
      for (const std::uint32_t m : midpoints_of(grip)) sum -= node(gradient, m);
      forces.emplace_back(sum);
    }
    return forces;
  }

  std::optional<Vec3> anchor_force() const override {
    const Eigen::VectorXd gradient = equilibrium_->gradient(positions_);
    Vec3 sum = Vec3::Zero();
    for (std::size_t v = 0; v < anchored_.size(); ++v) {
      if (anchored_[v] != 0) sum -= node(gradient, v);
    }
    for (std::size_t i = 0; i < elements_.midpoints().size(); ++i) {
      const Edge& ends = elements_.midpoints()[i];
      if (anchored_[ends[0]] != 0 && anchored_[ends[1]] != 0) {
        sum -= node(gradient, anchored_.size() + i);
      }
    }
    return sum;
  }

  std::vector<TetStrain> strains() const override {
    std::vector<TetStrain> result(body_.tets.size());
    for (std::size_t t = 0; t < result.size(); ++t) {
      for (const QuadraturePoint& point : elements_.quadrature()) {
        const TetStrain here = tet_strain(constitution_of(scene_.model), lame_[t],
                                          elastic_.deformation_gradient(t, point, positions_));
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

  static Vec3 node(const Eigen::VectorXd& all, std::size_t i) {
    return all.segment<3>(static_cast<Eigen::Index>(3 * i));
  }

  bool is_held_midpoint(std::size_t i) const {
    const Edge& ends = elements_.midpoints()[i];
    return taken_[ends[0]] != 0 && taken_[ends[1]] != 0;
  }

  // Taken vertices, and the midpoints between two of them.
  std::vector<std::uint8_t> held_nodes() const {
    std::vector<std::uint8_t> held = taken_;
    for (std::size_t i = 0; i < elements_.midpoints().size(); ++i) {
      held.push_back(is_held_midpoint(i));
    }
    return held;
  }

  std::vector<std::uint32_t> midpoints_of(const Grip& grip) const {
    std::vector<std::uint8_t> in_grip(body_.rest.size(), 0);
    for (const std::uint32_t v : grip.vertices()) in_grip[v] = 1;
    std::vector<std::uint32_t> result;
    const std::vector<Edge>& midpoints = elements_.midpoints();
    for (std::size_t i = 0; i < midpoints.size(); ++i) {
      if (in_grip[midpoints[i][0]] != 0 && in_grip[midpoints[i][1]] != 0) {
        result.push_back(static_cast<std::uint32_t>(body_.rest.size() + i));
      }
    }
    return result;
  }

  void find_taken() {
    taken_ = anchored_;
    for (const Grip& grip : grips_) {
      for (const std::uint32_t v : grip.vertices()) taken_[v] = 1;
    }
  }

  // Vertices go where the tools take them, midpoints half-way between them.
  Eigen::VectorXd motion_to(const ToolPoses& tools) const {
    Eigen::VectorXd motion = Eigen::VectorXd::Zero(positions_.size());
    for (std::size_t i = 0; i < tools.size(); ++i) {
      for (std::size_t k = 0; tools[i] && k < grips_[i].vertices().size(); ++k) {
        const std::uint32_t v = grips_[i].vertices()[k];
        motion.segment<3>(3 * Eigen::Index{v}) =
            grips_[i].place(k, *tools[i]) - node(positions_, v);
      }
    }
    for (std::size_t i = 0; i < elements_.midpoints().size(); ++i) {
      if (!is_held_midpoint(i)) continue;
      const Edge& ends = elements_.midpoints()[i];
      const std::size_t m = body_.rest.size() + i;
      const Vec3 middle = 0.5 * (node(positions_, ends[0]) + node(motion, ends[0]) +
                                 node(positions_, ends[1]) + node(motion, ends[1]));
      motion.segment<3>(static_cast<Eigen::Index>(3 * m)) = middle - node(positions_, m);
    }
    return motion;
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
      state_.positions[v] = node(positions_, v);
      report_.moved_vertices += state_.positions[v] != node(rest_, v);
    }
  }

  void put_to_rest() {
    for (Grip& grip : grips_) grip = {};
    positions_ = rest_;
    state_ = rest_state(body_);
    report_ = {};
    // Without a load, rest is the equilibrium.
    settled_ = !gravity_;
    regrip_ = false;
    find_taken();
    equilibrium_->hold(held_nodes());
    report_.energy = equilibrium_->energy(positions_);
  }

  const SceneDescription& scene_;
  const Body& body_;
  FiniteElements elements_;
  std::vector<Lame> lame_;
  ElasticEnergy elastic_;
  std::optional<GravityEnergy> gravity_;
  // For each vertex whether an anchor holds it; whether an anchor or a tool does.
  std::vector<std::uint8_t> anchored_, taken_;
  Eigen::VectorXd rest_, positions_;
  State state_;
  std::vector<Grip> grips_;
  std::unique_ptr<Equilibrium> equilibrium_;
  StepReport report_;
  bool settled_ = true, regrip_ = false;
};

}  // namespace

std::unique_ptr<DeformationModel> solid_model(const SceneDescription& scene, const Body& body,
                                              EffectCosts& costs, int threads) {
  return std::make_unique<SolidModel>(scene, body, costs, threads);
}

}  // namespace tissue
