#pragma once

#include "tissue/simulate/scene.h"

namespace tissue {

/// The scene without one of its effects. Without density_response the tissue is homogeneous, as
/// stiff as it was in the mean over the body; damping does not stay without inertia. Throws
/// InputError E_PARAM if the scene does not name the effect.
SceneDescription leave_out(SceneDescription scene, const std::string& effect, const Body& body);

}  // namespace tissue
