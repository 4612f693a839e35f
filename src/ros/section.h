#pragma once

#include "tissue/base/tet_mesh.h"
#include "tissue/base/topology.h"

#include <string>
#include <vector>

namespace tissue_ros {

/// Where a mesh is cut open to show its inside: whole tets with their centroid at rest on one side
/// of the plane stay.
struct Section {
  /// 0, 1, 2 for x, y, z; −1 for no section.
  int axis = 1;
  /// As a fraction of the mesh's extent along the axis.
  double at = 0.5;
  /// Whether what lies above the plane stays, instead of what lies below.
  bool keep_upper = false;
};

/// From the parameters; "none" or an axis that is none leaves the mesh whole.
Section section_from(const std::string& axis, double at);

/// The least box around vertices.
struct Extent {
  tissue::Vec3f low, high;
};
Extent extent_of(const std::vector<tissue::Vec3f>& vertices);

/// A face that is seen, its corners outward.
struct SeenFace {
  tissue::Triangle corners;
  std::uint32_t tet;
};

/// Cuts one mesh open, here and there: what does not depend on where is found once.
class OpenedMesh {
 public:
  /// `mesh` has to live as long.
  explicit OpenedMesh(const tissue::TetMesh& mesh);

  struct Faces {
    /// Of the mesh's own surface.
    std::vector<SeenFace> hull;
    /// What the section lays open.
    std::vector<SeenFace> cut;
  };
  Faces faces(const Section& section) const;

 private:
  const tissue::TetMesh& mesh_;
  Extent extent_;
  tissue::FaceTopology topology_;
};

}  // namespace tissue_ros
