#pragma once

#include "tissue/base/run.h"
#include "tissue/field/implicit_surface.h"

#include <vector>

namespace tissue {

/// How far a mesh's boundary vertices are from the implicit surface.
struct SurfaceDistance {
  std::size_t vertices = 0;
  double mean = 0.0;  // [m]
  double max = 0.0;   // [m]
  /// Vertices farther away than a tenth of the smallest voxel spacing.
  std::size_t astray = 0;
};

/// Measured to where search_surface() finds the surface; a vertex for which it finds nothing within
/// `reach` [m] counts as `reach`. `vertices` are places in the grid's frame.
SurfaceDistance surface_distance(const ImplicitSurface& surface, const std::vector<Vec3f>& vertices,
                                 const std::vector<Triangle>& boundary, double reach,
                                 const Run& run);

}  // namespace tissue
