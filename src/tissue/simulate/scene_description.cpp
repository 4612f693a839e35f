#include "tissue/simulate/scene_description.h"

#include <algorithm>

namespace tissue {

bool SceneDescription::has(const std::string& effect) const {
  return std::any_of(effects.begin(), effects.end(),
                     [&](const Effect& one) { return effect == one.name(); });
}

}  // namespace tissue
