#include "../averaged_volume.h"
#include "../effect_kind.h"
#include "../solver_choice.h"

#include <algorithm>

// Tissue that keeps its volume without locking. Elements keep as much resistance to changes of
// volume as a Poisson's ratio of 0.3 has, which does not lock and holds averages together; the rest
// is for averages around vertices.

namespace tissue::effects {
namespace {

struct Options {};

// λ by μ at that ratio.
constexpr double kLocalLambda = 1.5;

std::vector<Lame> local_part(std::vector<Lame> lame) {
  for (Lame& one : lame) one.lambda = std::min(one.lambda, kLocalLambda * one.mu);
  return lame;
}

class NearIncompressibility : public SolidEffect {
 public:
  explicit NearIncompressibility(const SolidParts& solid)
      : energy_(solid.elements, rest_of_lambda(solid), constitution_of(solid.scene.model)),
        is_quadratic_(solid.scene.model == Model::kLinear) {}
  const Energy* energy() const override { return &energy_; }
  bool is_quadratic() const override { return is_quadratic_; }
  bool adds_squares() const override { return true; }
  bool loads() const override { return false; }
  std::size_t bytes() const override { return energy_.bytes(); }

 private:
  static std::vector<double> rest_of_lambda(const SolidParts& solid) {
    std::vector<double> rest;
    for (const Lame& one : lame_of(solid.scene.material, solid.body)) {
      rest.push_back(std::max(one.lambda - kLocalLambda * one.mu, 0.0));
    }
    return rest;
  }

  AveragedVolumeEnergy energy_;
  bool is_quadratic_;
};

std::unique_ptr<SolidEffect> make(const Effect&, const SolidParts& solid) {
  return std::make_unique<NearIncompressibility>(solid);
}

bool is_elastic(Model model) { return is_solid(model) && model != Model::kMassSpring; }

}  // namespace

extern const EffectKind near_incompressibility = {"near_incompressibility",
                                                  typeid(Options),
                                                  is_elastic,
                                                  read_nothing<Options>,
                                                  nullptr,
                                                  make,
                                                  local_part};

}  // namespace tissue::effects
