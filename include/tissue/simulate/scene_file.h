#pragma once

#include "tissue/simulate/scene.h"

#include <string>

namespace tissue {

/// Reads a scene, strictly: an unknown word, a value out of range or an effect that the model
/// cannot have is an InputError (E_SCENE, E_PARAM or E_FILE) whose sentence names the line and the
/// key. Keys that the model does not use (for closed_form `material`, `anchors`,
/// `solver` and `element_order`, for others `range`, `literal` and `rise_time`) are checked and
/// otherwise ignored.
SceneDescription parse_scene(const std::string& yaml);
/// What a scene file holds. Throws InputError E_FILE if it cannot be read.
std::string scene_text(const std::string& path);
SceneDescription read_scene(const std::string& path);

}  // namespace tissue
