#pragma once

#include "tissue/base/yaml_reader.h"
#include "tissue/simulate/material.h"

namespace tissue {

/// Reads rows of density and Young's modulus [Pa]. Throws InputError as read_scene(). Without
/// `by_density` there must be one.
std::vector<std::array<double, 2>> young_from(const YamlReader& reader, bool by_density);

/// Reads a scene's material in the same way.
Material material_from(const YamlReader& reader, bool by_density);

}  // namespace tissue
