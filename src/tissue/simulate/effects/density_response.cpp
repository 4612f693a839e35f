#include "../effect_kind.h"

// Stiffness by density: the material's table has more than one row only with this effect, and
// closed_form weighs by it.

namespace tissue::effects {
namespace {

std::any read(const YamlReader* parameters, Model model) {
  if (!is_closed_form(model)) return read_nothing<DensityResponseOptions>(parameters, model);
  DensityResponseOptions options;
  if (parameters == nullptr) return options;
  parameters->require_keys({"reference"});
  if (parameters->has("reference")) {
    options.reference = parameters->at("reference").number(0.0, kHugeParameter, true);
  }
  return options;
}

}  // namespace

extern const EffectKind density_response = {"density_response", typeid(DensityResponseOptions),
                                            is_any, read};

}  // namespace tissue::effects
