#pragma once

#include "tissue/field/implicit_surface.h"

#include <vector>

namespace tissue {

/// Mean and maximum distance [m] of a mesh's boundary vertices from the implicit surface: to its
/// first crossing along the gradient, or where there is none within `reach` [m], to the nearest
/// crossing in 26 directions; a vertex without any counts as `reach`. `vertices` are places in the
/// grid's frame.
std::array<double, 2> surface_distance(const ImplicitSurface& surface,
                                       const std::vector<Vec3f>& vertices,
                                       const std::vector<Triangle>& boundary, double reach,
                                       int threads);

}  // namespace tissue
