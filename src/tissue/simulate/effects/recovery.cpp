#include "../effect_kind.h"

namespace tissue::effects {
namespace {

std::any read(const YamlReader* parameters, Model) {
  RecoveryOptions options;
  if (parameters == nullptr) return options;
  parameters->require_keys({"time"});
  if (parameters->has("time")) options.time = parameters->at("time").number(0.0, 3600.0, true);
  return options;
}

}  // namespace

extern const EffectKind recovery = {"recovery", typeid(RecoveryOptions), is_closed_form, read};

}  // namespace tissue::effects
