#pragma once

#include "tissue/simulate/body.h"

namespace tissue {

/// For each point [m] the tet of the body at rest that holds it, or else the nearest, of several
/// the first; barycentric coordinates outside go on linearly.
std::vector<TetPlace> material_places(const Body& body, const std::vector<Vec3>& points);

}  // namespace tissue
