#include "solid.h"

#include "deformation_model.h"
#include "tet_strains.h"
#include "tissue/simulate/spring_energy.h"

#include <utility>

namespace tissue {
namespace {

Run run_on(int threads) {
  Run run;
  run.threads = threads;
  return run;
}

RigidInclusions inclusions_of(const SceneDescription& scene, const Body& body, EffectCosts& costs) {
  const auto* const options = scene.find<RigidInclusionsOptions>();
  if (options == nullptr) return {};
  EffectCost& cost = *costs.of<RigidInclusionsOptions>();
  const CostClock clock(&cost);
  RigidInclusions inclusions(body, options->density_above);
  cost.bytes = inclusions.bytes();
  return inclusions;
}

std::vector<int> held_by_anchors(const Body& body, const SceneDescription& scene) {
  std::vector<int> holders = anchors_of_vertices(body, scene.anchors);
  // What has inertia may fly.
  if (!scene.has<InertiaOptions>()) require_held(body, holders, beds_of(body, scene.anchors));
  return holders;
}

}  // namespace

Solid::Solid(const SceneDescription& scene, const Body& body, EffectCosts& costs, int threads)
    : scene_(scene),
      body_(body),
      inclusions_(inclusions_of(scene, body, costs)),
      soft_body_(inclusions_.empty() ? Body() : inclusions_.soft_part(body)),
      elements_(elastic_body(), scene.element_order, inclusions_.tets),
      young_(young_of(scene.material, elastic_body())),
      held_(elements_, scene.tools, scene.anchors.size(), held_by_anchors(body, scene),
            inclusions_.vertices) {
  make_tissue(costs, threads);
  potentials_ = {tissue_.get()};
  if (SoftHolds::are_in(scene)) {
    soft_.emplace(scene, elements_, elastic_body());
    add_part(*soft_, nullptr);
  }
  for (std::size_t i = 0; i < scene.effects.size(); ++i) make_effect(i, costs.at(i));
  if (!inclusions_.empty()) {
    costs.of<RigidInclusionsOptions>()->bytes += soft_body_.bytes();
    motions_.emplace(inclusions_, elements_, scene.model == Model::kLinear,
                     *costs.of<RigidInclusionsOptions>());
    needs_.motions = &*motions_;
  }
  std::vector<const Energy*> energies = potentials_;
  if (scene.has<InertiaOptions>()) {
    dynamics_ = std::make_unique<Dynamics>(scene, elements_, *tissue_, costs);
    for (const Energy* energy : dynamics_->energies()) energies.push_back(energy);
  }
  equilibrium_ = equilibrium_for(scene, elements_, std::move(energies), needs_, run_on(threads));
  actions_.emplace(scene.tools, held_, parts_);
}

void Solid::make_tissue(EffectCosts& costs, int threads) {
  EffectCost* const cost = costs.of<DensityResponseOptions>();
  const CostClock clock(cost);
  std::size_t bytes = 0;
  if (scene_.model == Model::kMassSpring) {
    tissue_ = std::make_unique<SpringEnergy>(elements_, young_);
  } else {
    auto elastic = std::make_unique<ElasticEnergy>(elements_, local_lame(),
                                                   constitution_of(scene_.model), run_on(threads));
    bytes = elastic->bytes();
    elastic_ = elastic.get();
    tissue_ = std::move(elastic);
  }
  needs_.is_quadratic = scene_.model == Model::kLinear;
  if (cost != nullptr) cost->bytes = bytes;
}

std::vector<Lame> Solid::local_lame() const {
  std::vector<Lame> lame = lame_of(scene_.material, elastic_body());
  for (const Effect& effect : scene_.effects) {
    if (effect.kind().local_part != nullptr) lame = effect.kind().local_part(std::move(lame));
  }
  return lame;
}

void Solid::make_effect(std::size_t number, EffectCost& cost) {
  const Effect& effect = scene_.effects[number];
  if (effect.kind().make == nullptr) return;
  const CostClock clock(&cost);
  effects_.push_back(effect.kind().make(effect, {scene_, elastic_body(), elements_, young_}));
  cost.bytes = effects_.back()->bytes();
  if (effects_.back()->adds_squares()) needs_.squares = &cost;
  add_part(*effects_.back(), &cost);
}

void Solid::add_part(SolidEffect& effect, EffectCost* cost) {
  parts_.push_back({&effect, cost});
  if (const Energy* const energy = effect.energy()) {
    counted_.push_back(std::make_unique<CountedEnergy>(*energy, cost));
    potentials_.push_back(counted_.back().get());
    needs_.is_quadratic = needs_.is_quadratic && effect.is_quadratic();
  }
  if (effect.link() != nullptr) links_.push_back(effect.link());
}

double Solid::potential_energy(const Eigen::VectorXd& positions) const {
  double sum = 0.0;
  for (const Energy* energy : potentials_) sum += energy->value(positions);
  return sum;
}

std::vector<NodeWeight> Solid::shape_at(const TetPlace& place) const {
  const std::optional<std::size_t> element = element_of(place.tet);
  return element ? elements_.shape_at(*element, place.barycentric)
                 : linear_shape(body_.tets[place.tet], place);
}

std::vector<TetStrain> Solid::strains(const Eigen::VectorXd& positions) const {
  if (elastic_ == nullptr) return {};
  const std::vector<TetStrain> soft = tet_strains(elements_, *elastic_, positions);
  std::vector<TetStrain> result(body_.tets.size(), TetStrain{0.0, 0.0, 1.0});
  for (std::size_t t = 0; t < result.size(); ++t) {
    if (const std::optional<std::size_t> element = element_of(t)) result[t] = soft[*element];
  }
  return result;
}

std::vector<std::optional<Vec3>> Solid::tool_forces(const Eigen::VectorXd& positions) const {
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

std::vector<Vec3> Solid::anchor_forces(const Eigen::VectorXd& positions) const {
  std::vector<Vec3> forces = forces_on_holders(positions);
  forces.resize(scene_.anchors.size());
  if (soft_) soft_->add_anchor_forces(positions, forces);
  return forces;
}

}  // namespace tissue
