#pragma once

#include "tissue/field/implicit_surface.h"

namespace tissue {

struct SamplePointOptions {
  /// About so many points in the organ: more, finer.
  int organ = 20000;
  /// About so many in the tumour.
  int tumour = 2000;
  /// Tissue denser than this is the tumour.
  double tumour_above = 230.0;
};

/// The places at which all solutions of a study are compared, whatever their meshes [m, world].
struct SamplePoints {
  std::vector<Vec3> organ;
  std::vector<Vec3> tumour;
};

/// Points of regular grids: inside the surface, and where it is denser than the tumour is to be. Of
/// the organ's points those that hang together as most do: meshes drop loose parts. Throws
/// InputError E_PARAM if no tissue is a tumour.
SamplePoints sample_points(const Volume& volume, const ImplicitSurface& surface,
                           const SamplePointOptions& options = {});

}  // namespace tissue
