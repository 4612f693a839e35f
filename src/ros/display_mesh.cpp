#include "ros/display_mesh.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace tissue_ros {
namespace {

using tissue::TetMesh;
using tissue::Vec3f;
using Faces = std::vector<DisplayMesh::Face>;

// Merges the vertices within each cube of the given size into the first of them; triangles that
// shrink to nothing go.
Faces clustered(const Faces& faces, const std::vector<Vec3f>& vertices, const Vec3f& low,
                float size) {
  std::unordered_map<std::uint64_t, std::uint32_t> cubes;
  const auto representative = [&](std::uint32_t vertex) {
    const Vec3f cell = (vertices[vertex] - low) / size;
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) key = key << 21 | static_cast<std::uint64_t>(cell[axis]);
    return cubes.emplace(key, vertex).first->second;
  };
  Faces result;
  for (const DisplayMesh::Face& face : faces) {
    DisplayMesh::Face merged = face;
    for (std::uint32_t& corner : merged.corners) corner = representative(corner);
    const auto& c = merged.corners;
    if (c[0] != c[1] && c[1] != c[2] && c[2] != c[0]) result.push_back(merged);
  }
  return result;
}

Faces thinned(const Faces& faces, const TetMesh& mesh, const Extent& extent, std::size_t most) {
  if (faces.size() <= most) return faces;
  // The number of triangles falls with the square of the cubes' size.
  float size = 0.003f * (extent.high - extent.low).maxCoeff();
  Faces result = faces;
  while (result.size() > most) {
    result = clustered(faces, mesh.vertices, extent.low, size);
    const double excess = static_cast<double>(result.size()) / static_cast<double>(most + 1);
    size *= std::max(1.05f, static_cast<float>(std::sqrt(excess)));
  }
  return result;
}

Faces with_levels(const std::vector<SeenFace>& seen, const TetMesh& mesh) {
  Faces faces;
  faces.reserve(seen.size());
  for (const SeenFace& face : seen) faces.push_back({face.corners, mesh.levels[face.tet]});
  return faces;
}

}  // namespace

DisplayMesh display_mesh(const TetMesh& mesh, const Section& section, std::size_t max_triangles) {
  const OpenedMesh::Faces seen = OpenedMesh(mesh).faces(section);
  const Extent extent = extent_of(mesh.vertices);
  DisplayMesh display{with_levels(seen.hull, mesh), with_levels(seen.cut, mesh)};
  display.cut = thinned(display.cut, mesh, extent, max_triangles * 7 / 10);
  display.hull = thinned(display.hull, mesh, extent, max_triangles - display.cut.size());
  return display;
}

}  // namespace tissue_ros
