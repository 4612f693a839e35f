#include "../effect_kind.h"

// What it does stands in dynamics.cpp.

namespace tissue::effects {
namespace {

std::any read(const YamlReader* parameters, Model) {
  DampingOptions options;
  if (parameters == nullptr) return options;
  parameters->require_keys({"mass", "stiffness"});
  if (parameters->has("mass")) options.mass = parameters->at("mass").number(0.0, kHugeParameter);
  if (parameters->has("stiffness")) {
    options.stiffness = parameters->at("stiffness").number(0.0, kHugeParameter);
  }
  return options;
}

std::string objection(const SceneDescription& scene) {
  return scene.has<InertiaOptions>() ? ""
                                     : "damping without inertia: nothing swings that it could damp";
}

}  // namespace

extern const EffectKind damping = {"damping", typeid(DampingOptions), is_solid, read, objection};

}  // namespace tissue::effects
