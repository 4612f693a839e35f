#pragma once

#include "solid_effect.h"
#include "tissue/base/yaml_reader.h"
#include "tissue/simulate/scene_description.h"

#include <memory>

namespace tissue {

/// All that is to be known of an effect: each has its own file in effects/, where this and
/// everything that it does to a solid stand, and a line in effects.cpp.
struct EffectKind {
  /// By which scenes name it.
  const char* name;
  /// Of its parameters.
  const std::type_info& options;
  bool (*suits)(Model model);
  /// What a scene says of it; nothing where that is only its name. Throws InputError.
  std::any (*read)(const YamlReader* parameters, Model model);
  /// Why it makes no sense in a scene, or nothing.
  std::string (*objection)(const SceneDescription& scene) = nullptr;
  /// What it is in a solid; nothing where the solid itself asks for its parameters.
  std::unique_ptr<SolidEffect> (*make)(const Effect& effect, const SolidParts& solid) = nullptr;
  /// What it leaves elements to store themselves; nothing where that is all.
  std::vector<Lame> (*local_part)(std::vector<Lame> lame) = nullptr;
};

/// Nothing if there is none of that name.
const EffectKind* effect_named(const std::string& name);

inline bool is_solid(Model model) { return model != Model::kClosedForm; }
inline bool is_closed_form(Model model) { return model == Model::kClosedForm; }
inline bool is_any(Model) { return true; }

/// For effects without parameters.
template <class Options>
std::any read_nothing(const YamlReader* parameters, Model) {
  if (parameters != nullptr) parameters->require_keys({});
  return Options{};
}

/// A scene's places and vectors.
Vec3 vector_from(const YamlReader& reader, const char* what);

constexpr double kHugeParameter = 1e12;

}  // namespace tissue
