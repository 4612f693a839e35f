#pragma once

#include "tissue/base/yaml_reader.h"
#include "tissue/simulate/anchors.h"

namespace tissue {

/// Reads the list of a scene's anchors. Throws InputError as read_scene().
std::vector<Anchor> anchors_from(const YamlReader& reader);

}  // namespace tissue
