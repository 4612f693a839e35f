#pragma once

#include "ros/section.h"

#include <vector>

namespace tissue_ros {

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
