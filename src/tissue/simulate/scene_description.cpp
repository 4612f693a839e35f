#include "tissue/simulate/scene_description.h"

#include <algorithm>

namespace tissue {

const char* name(Model model) {
  switch (model) {
    case Model::kClosedForm: return "closed_form";
    case Model::kMassSpring: return "mass_spring";
    case Model::kLinear: return "linear";
    case Model::kCorotational: return "corotational";
    case Model::kNeoHookean: return "neo_hookean";
  }
  return "";
}

const char* name(Effect effect) {
  switch (effect) {
    case Effect::kDensityResponse: return "density_response";
    case Effect::kRecovery: return "recovery";
    case Effect::kFoldGuard: return "fold_guard";
    case Effect::kGravity: return "gravity";
    case Effect::kInertia: return "inertia";
    case Effect::kDamping: return "damping";
    case Effect::kForceFeedback: return "force_feedback";
  }
  return "";
}

const std::vector<Model>& all_models() {
  static const std::vector<Model> models = {Model::kClosedForm, Model::kMassSpring, Model::kLinear,
                                            Model::kCorotational, Model::kNeoHookean};
  return models;
}

const std::vector<Effect>& all_effects() {
  static const std::vector<Effect> effects = {
      Effect::kDensityResponse, Effect::kRecovery, Effect::kFoldGuard,    Effect::kGravity,
      Effect::kInertia,         Effect::kDamping,  Effect::kForceFeedback};
  return effects;
}

bool can_have(Model model, Effect effect) {
  switch (effect) {
    case Effect::kDensityResponse: return true;
    case Effect::kRecovery:
    case Effect::kFoldGuard: return model == Model::kClosedForm;
    case Effect::kGravity:
    case Effect::kInertia:
    case Effect::kDamping:
    case Effect::kForceFeedback: return model != Model::kClosedForm;
  }
  return false;
}

std::string effects_table() {
  std::string head = "| effect |", rule = "|---|", rows;
  for (const Model model : all_models()) {
    head += std::string(" `") + name(model) + "` |";
    rule += "---|";
  }
  for (const Effect effect : all_effects()) {
    rows += std::string("| `") + name(effect) + "` |";
    for (const Model model : all_models()) rows += can_have(model, effect) ? " yes |" : " – |";
    rows += "\n";
  }
  return head + "\n" + rule + "\n" + rows;
}

bool SceneDescription::has(Effect effect) const {
  return std::find(effects.begin(), effects.end(), effect) != effects.end();
}

}  // namespace tissue
