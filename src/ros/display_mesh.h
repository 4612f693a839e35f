#pragma once

#include "tissue/base/tet_mesh.h"

#include <string>
#include <vector>

namespace tissue_ros {

/// Where a mesh is cut open to show its inside: whole tets with their centroid below the plane
/// stay.
struct Section {
  /// 0, 1, 2 for x, y, z; −1 for no section.
  int axis = 1;
  /// As a fraction of the mesh's extent along the axis.
  double at = 0.5;
};

/// From the parameters; "none" or an axis that is none leaves the mesh whole.
Section section_from(const std::string& axis, double at);

/// The part of a mesh that is drawn: triangles between the mesh's own vertices, so that they move
/// with them.
struct DisplayMesh {
  struct Face {
    tissue::Triangle corners;
    std::uint8_t level;
  };
  /// The outer surface, thinned out where there are too many.
  std::vector<Face> hull;
  /// The faces of tets that the section lays open.
  std::vector<Face> cut;
};

/// At most about `max_triangles` triangles: the section comes first, with up to seven tenths.
DisplayMesh display_mesh(const tissue::TetMesh& mesh, const Section& section,
                         std::size_t max_triangles);

}  // namespace tissue_ros
