#include "../effect_kind.h"

// Tissue denser than a value moves as rigid bodies, as the paper's tumour does. What they are
// stands in rigid_inclusions.cpp, how they are solved for in rigid_system.cpp.

namespace tissue::effects {
namespace {

std::any read(const YamlReader* parameters, Model) {
  RigidInclusionsOptions options;
  if (parameters == nullptr) return options;
  parameters->require_keys({"density_above"});
  if (parameters->has("density_above")) {
    options.density_above = parameters->at("density_above").number(0.0, kHugeParameter);
  }
  return options;
}

}  // namespace

extern const EffectKind rigid_inclusions = {"rigid_inclusions", typeid(RigidInclusionsOptions),
                                            is_solid, read};

}  // namespace tissue::effects
