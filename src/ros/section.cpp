#include "ros/section.h"

#include <limits>

namespace tissue_ros {

using tissue::Tet;
using tissue::Vec3f;

Section section_from(const std::string& axis, double at) {
  const std::string axes = "xyz";
  const std::size_t found = axis.size() == 1 ? axes.find(axis) : std::string::npos;
  return {found == std::string::npos ? -1 : static_cast<int>(found), at};
}

Extent extent_of(const std::vector<Vec3f>& vertices) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Extent extent{Vec3f::Constant(kInfinity), Vec3f::Constant(-kInfinity)};
  for (const Vec3f& vertex : vertices) {
    extent.low = extent.low.cwiseMin(vertex);
    extent.high = extent.high.cwiseMax(vertex);
  }
  return extent;
}

OpenedMesh::OpenedMesh(const tissue::TetMesh& mesh)
    : mesh_(mesh),
      extent_(extent_of(mesh.vertices)),
      topology_(tissue::face_topology(mesh.tets, mesh.vertices.size())) {}

OpenedMesh::Faces OpenedMesh::faces(const Section& section) const {
  const auto is_kept = [&](std::uint32_t t) {
    if (section.axis < 0) return true;
    const auto a = section.axis;
    float sum = 0.0f;
    for (const std::uint32_t v : mesh_.tets[t]) sum += mesh_.vertices[v][a];
    const auto at = static_cast<float>(section.at);
    const float plane = extent_.low[a] + at * (extent_.high[a] - extent_.low[a]);
    return section.keep_upper ? 0.25f * sum >= plane : 0.25f * sum < plane;
  };
  std::vector<std::uint8_t> kept(mesh_.tets.size());
  for (std::uint32_t t = 0; t < kept.size(); ++t) kept[t] = is_kept(t);
  Faces faces;
  for (std::uint32_t t = 0; t < kept.size(); ++t) {
    if (kept[t] == 0) continue;
    for (int f = 0; f < 4; ++f) {
      const auto& [first, second] = topology_.face_tets[topology_.tet_faces[t][f]];
      const bool is_hull = second == tissue::kNoTet;
      if (!is_hull && kept[first == t ? second : first] != 0) continue;
      const auto& c = tissue::kOutwardFaces[f];
      const Tet& tet = mesh_.tets[t];
      (is_hull ? faces.hull : faces.cut).push_back({{tet[c[0]], tet[c[1]], tet[c[2]]}, t});
    }
  }
  return faces;
}

}  // namespace tissue_ros
