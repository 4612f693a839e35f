#include "tissue/simulate/gravity.h"

#include "../effect_kind.h"

namespace tissue::effects {
namespace {

struct GravityOptions {
  // [m/s²]
  Vec3 vector = {0.0, 0.0, -9.81};
};

std::any read(const YamlReader* parameters, Model) {
  GravityOptions options;
  if (parameters == nullptr) return options;
  parameters->require_keys({"vector"});
  if (parameters->has("vector")) {
    options.vector = vector_from(parameters->at("vector"), "a vector [x, y, z]");
  }
  return options;
}

class Gravity : public SolidEffect {
 public:
  Gravity(const GravityOptions& options, const SolidParts& solid)
      : energy_(solid.elements, solid.scene.material.mass_density, options.vector) {}
  const Energy* energy() const override { return &energy_; }
  std::size_t bytes() const override { return energy_.bytes(); }

 private:
  GravityEnergy energy_;
};

std::unique_ptr<SolidEffect> make(const Effect& effect, const SolidParts& solid) {
  return std::make_unique<Gravity>(*effect.options<GravityOptions>(), solid);
}

}  // namespace

extern const EffectKind gravity = {"gravity", typeid(GravityOptions), is_solid, read, nullptr,
                                   make};

}  // namespace tissue::effects
