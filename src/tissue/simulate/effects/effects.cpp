#include "../effect_kind.h"

#include <algorithm>
#include <stdexcept>

// A line for each effect, in the order in which tables have them.
#define TISSUE_EFFECTS(EFFECT)   \
  EFFECT(density_response)       \
  EFFECT(recovery)               \
  EFFECT(fold_guard)             \
  EFFECT(gravity)                \
  EFFECT(inertia)                \
  EFFECT(damping)                \
  EFFECT(near_incompressibility) \
  EFFECT(rigid_inclusions)       \
  EFFECT(contact)                \
  EFFECT(force_feedback)

namespace tissue {
namespace effects {

#define TISSUE_DECLARE(NAME) extern const EffectKind NAME;
TISSUE_EFFECTS(TISSUE_DECLARE)

}  // namespace effects

namespace {

const std::vector<const EffectKind*>& all_kinds() {
#define TISSUE_ADDRESS(NAME) &effects::NAME,
  static const std::vector<const EffectKind*> kinds = {TISSUE_EFFECTS(TISSUE_ADDRESS)};
  return kinds;
}

template <class Chosen>
const EffectKind* find(const Chosen& chosen) {
  const auto& all = all_kinds();
  const auto found = std::find_if(all.begin(), all.end(), chosen);
  return found == all.end() ? nullptr : *found;
}

}  // namespace

const EffectKind* effect_named(const std::string& name) {
  return find([&](const EffectKind* kind) { return name == kind->name; });
}

const EffectKind& Effect::kind_of(const std::type_info& options) {
  const EffectKind* const kind =
      find([&](const EffectKind* one) { return one->options == options; });
  if (kind == nullptr) throw std::logic_error(std::string("no effect has ") + options.name());
  return *kind;
}

std::string objection_to(const Effect& effect, const SceneDescription& scene) {
  const auto objection = effect.kind().objection;
  return objection == nullptr ? "" : objection(scene);
}

const char* Effect::name() const { return kind_->name; }

std::vector<std::string> effect_names() {
  std::vector<std::string> names;
  for (const EffectKind* kind : all_kinds()) names.emplace_back(kind->name);
  return names;
}

bool can_have(Model model, const std::string& effect) {
  const EffectKind* const kind = effect_named(effect);
  return kind != nullptr && kind->suits(model);
}

std::string effects_table() {
  std::string head = "| effect |", rule = "|---|", rows;
  for (const Model model : all_models()) {
    head += std::string(" `") + name(model) + "` |";
    rule += "---|";
  }
  for (const EffectKind* kind : all_kinds()) {
    rows += std::string("| `") + kind->name + "` |";
    for (const Model model : all_models()) rows += kind->suits(model) ? " yes |" : " – |";
    rows += "\n";
  }
  return head + "\n" + rule + "\n" + rows;
}

Vec3 vector_from(const YamlReader& reader, const char* what) {
  const std::vector<YamlReader> entries = reader.entries();
  if (entries.size() != 3) reader.refuse(std::string("is not ") + what);
  Vec3 place;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    place[static_cast<Eigen::Index>(axis)] = entries[axis].number(-kHugeParameter, kHugeParameter);
  }
  return place;
}

}  // namespace tissue
