#include "ros/display_mesh.h"

#include "tissue/base/topology.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace tissue_ros {
namespace {

using tissue::Tet;
using tissue::TetMesh;
using tissue::Vec3f;
using Faces = std::vector<DisplayMesh::Face>;

struct Extent {
  Vec3f low, high;
};

Extent extent_of(const TetMesh& mesh) {
  Extent extent{Vec3f::Constant(std::numeric_limits<float>::infinity()),
                Vec3f::Constant(-std::numeric_limits<float>::infinity())};
  for (const Vec3f& vertex : mesh.vertices) {
    extent.low = extent.low.cwiseMin(vertex);
    extent.high = extent.high.cwiseMax(vertex);
  }
  return extent;
}

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

}  // namespace

Section section_from(const std::string& axis, double at) {
  const std::string axes = "xyz";
  const std::size_t found = axis.size() == 1 ? axes.find(axis) : std::string::npos;
  return {found == std::string::npos ? -1 : static_cast<int>(found), at};
}

DisplayMesh display_mesh(const TetMesh& mesh, const Section& section, std::size_t max_triangles) {
  const Extent extent = extent_of(mesh);
  std::vector<Tet> kept;
  std::vector<std::uint8_t> levels;
  const auto is_kept = [&](const Tet& tet) {
    if (section.axis < 0) return true;
    const auto a = section.axis;
    float sum = 0.0f;
    for (const std::uint32_t v : tet) sum += mesh.vertices[v][a];
    const auto at = static_cast<float>(section.at);
    return 0.25f * sum < extent.low[a] + at * (extent.high[a] - extent.low[a]);
  };
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!is_kept(mesh.tets[t])) continue;
    kept.push_back(mesh.tets[t]);
    levels.push_back(mesh.levels[t]);
  }
  std::vector<std::uint8_t> on_surface(mesh.vertices.size(), 0);
  for (const tissue::Triangle& triangle : mesh.surface) {
    for (const std::uint32_t v : triangle) on_surface[v] = 1;
  }
  DisplayMesh display;
  const tissue::FaceTopology faces = tissue::face_topology(kept, mesh.vertices.size());
  for (std::size_t t = 0; t < kept.size(); ++t) {
    for (int f = 0; f < 4; ++f) {
      if (faces.face_tets[faces.tet_faces[t][f]][1] != tissue::kNoTet) continue;
      const auto& c = tissue::kOutwardFaces[f];
      const tissue::Triangle corners = {kept[t][c[0]], kept[t][c[1]], kept[t][c[2]]};
      const bool outer =
          on_surface[corners[0]] + on_surface[corners[1]] + on_surface[corners[2]] == 3;
      (outer ? display.hull : display.cut).push_back({corners, levels[t]});
    }
  }
  display.cut = thinned(display.cut, mesh, extent, max_triangles * 7 / 10);
  display.hull = thinned(display.hull, mesh, extent, max_triangles - display.cut.size());
  return display;
}

}  // namespace tissue_ros
