#include "../effect_kind.h"

// What it does stands in dynamics.cpp.

namespace tissue::effects {
namespace {

std::any read(const YamlReader* parameters, Model) {
  InertiaOptions options;
  if (parameters == nullptr) return options;
  parameters->require_keys({"substep", "iterations"});
  if (parameters->has("substep")) {
    options.substep = parameters->at("substep").number(0.0, 3600.0, true);
  }
  if (parameters->has("iterations")) {
    options.iterations = static_cast<int>(parameters->at("iterations").number(1.0, 1e6));
  }
  return options;
}

}  // namespace

extern const EffectKind inertia = {"inertia", typeid(InertiaOptions), is_solid, read};

}  // namespace tissue::effects
