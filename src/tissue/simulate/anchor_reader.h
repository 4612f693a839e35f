#pragma once

#include "tissue/simulate/anchors.h"
#include "yaml_reader.h"

namespace tissue {

/// Reads the list of a scene's anchors. Throws InputError as read_scene().
std::vector<Anchor> anchors_from(const YamlReader& reader);

}  // namespace tissue
