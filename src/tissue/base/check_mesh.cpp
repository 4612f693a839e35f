#include "tissue/base/check_mesh.h"

#include "tissue/base/boundary.h"
#include "tissue/base/error.h"
#include "tissue/base/topology.h"

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

void require_length(const std::string& field, std::size_t length, std::size_t expected) {
  if (length == expected) return;
  throw InputError(ErrorCode::kSizeMismatch, "mesh: " + field + " has " + std::to_string(length) +
                                                 " entries, not " + std::to_string(expected));
}

template <class Index>
void require_indices(const std::string& field, const std::vector<Index>& indices,
                     std::size_t vertex_count) {
  for (std::size_t i = 0; i < indices.size(); ++i) {
    for (const std::uint32_t vertex : indices[i]) {
      if (vertex < vertex_count) continue;
      throw InputError(ErrorCode::kSizeMismatch, "mesh: " + field + "[" + std::to_string(i) +
                                                     "] names vertex " + std::to_string(vertex) +
                                                     " of " + std::to_string(vertex_count));
    }
  }
}

void require_densities(const std::string& field, const std::vector<float>& densities) {
  for (std::size_t i = 0; i < densities.size(); ++i) {
    if (std::isfinite(densities[i]) && densities[i] > 0.0f) continue;
    throw InputError(std::isfinite(densities[i]) ? ErrorCode::kParam : ErrorCode::kNonfinite,
                     "mesh: " + field + "[" + std::to_string(i) + "] is " +
                         to_text(static_cast<double>(densities[i])));
  }
}

// The first few, for a message.
std::string head_of(const std::vector<std::size_t>& numbers) {
  constexpr std::size_t kShown = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(numbers.size(), kShown); ++i) {
    text += (i > 0 ? ", " : "") + std::to_string(numbers[i]);
  }
  return text + (numbers.size() > kShown ? ", …" : "");
}

// Vertices that lie in the middle of a boundary edge: where the tets on one side of a face are
// finer than on the other, both sides look like boundary.
std::vector<std::size_t> hanging_nodes(const TetMesh& mesh,
                                       const std::vector<BoundaryTriangle>& boundary) {
  std::vector<std::uint8_t> used(mesh.vertices.size(), 0);
  std::vector<Edge> edges;
  for (const BoundaryTriangle& triangle : boundary) {
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = triangle.corners[i], b = triangle.corners[(i + 1) % 3];
      used[a] = 1;
      if (a < b) edges.push_back({a, b});
    }
  }
  std::vector<std::uint32_t> by_x;
  for (std::uint32_t v = 0; v < used.size(); ++v) {
    if (used[v] != 0) by_x.push_back(v);
  }
  const auto x_of = [&](std::uint32_t v) { return static_cast<double>(mesh.vertices[v].x()); };
  std::sort(by_x.begin(), by_x.end(),
            [&](std::uint32_t a, std::uint32_t b) { return x_of(a) < x_of(b); });
  std::vector<std::size_t> found;
  for (const Edge& edge : edges) {
    const Vec3 a = mesh.vertices[edge[0]].cast<double>(), b = mesh.vertices[edge[1]].cast<double>();
    const Vec3 middle = 0.5 * (a + b);
    // What rounding to single precision makes of a midpoint.
    const double tolerance = 1e-6 * (b - a).norm() + 1e-7 * middle.norm();
    auto near = std::lower_bound(by_x.begin(), by_x.end(), middle.x() - tolerance,
                                 [&](std::uint32_t v, double x) { return x_of(v) < x; });
    for (; near != by_x.end() && x_of(*near) <= middle.x() + tolerance; ++near) {
      if ((mesh.vertices[*near].cast<double>() - middle).norm() <= tolerance) {
        found.push_back(*near);
      }
    }
  }
  return found;
}

void require_conforming(const TetMesh& mesh) {
  const FaceTopology faces = face_topology(mesh.tets, mesh.vertices.size());
  std::vector<BoundaryTriangle> boundary;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    for (int f = 0; f < 4; ++f) {
      if (faces.face_tets[faces.tet_faces[t][f]][1] != kNoTet) continue;
      const auto& c = kOutwardFaces[f];
      boundary.push_back({t, {mesh.tets[t][c[0]], mesh.tets[t][c[1]], mesh.tets[t][c[2]]}});
    }
  }
  const auto refuse = [](const std::vector<std::size_t>& bad, const std::string& what) {
    if (bad.empty()) return;
    throw InputError(ErrorCode::kConformity,
                     "mesh: " + std::to_string(bad.size()) + what + head_of(bad));
  };
  refuse(hanging_nodes(mesh, boundary), " vertices hang in the middle of an edge: vertices ");
  const std::vector<std::uint32_t> pinched = find_defects(boundary, mesh.vertices.size()).vertices;
  refuse({pinched.begin(), pinched.end()},
         " vertices where the boundary is no manifold: vertices ");
}

}  // namespace

void check_mesh(const TetMesh& mesh) {
  const std::size_t vertices = mesh.vertices.size();
  require_length("levels", mesh.levels.size(), mesh.tets.size());
  require_length("densities", mesh.densities.size(), vertices);
  require_length("tet_densities", mesh.tet_densities.size(), mesh.tets.size());
  if (!mesh.parents.empty()) {
    if (mesh.lattice_vertices > vertices) {
      throw InputError(ErrorCode::kSizeMismatch, "mesh: lattice_vertices is " +
                                                     std::to_string(mesh.lattice_vertices) +
                                                     " of " + std::to_string(vertices));
    }
    require_length("parents", mesh.parents.size(), vertices - mesh.lattice_vertices);
  }
  require_indices("tetrahedra", mesh.tets, vertices);
  require_indices("surface", mesh.surface, vertices);
  require_indices("parents", mesh.parents, vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    if (mesh.vertices[v].allFinite()) continue;
    throw InputError(ErrorCode::kNonfinite,
                     "mesh: vertices[" + std::to_string(v) + "] is not finite");
  }
  require_densities("densities", mesh.densities);
  require_densities("tet_densities", mesh.tet_densities);
  std::vector<std::size_t> bad;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& tet = mesh.tets[t];
    if (determinant(mesh.vertices, tet) > 0.0) {
      continue;
    }
    bad.push_back(t);
  }
  if (!bad.empty()) {
    throw InputError(ErrorCode::kMeshQuality, "mesh: " + std::to_string(bad.size()) +
                                                  " tets are flat or inverted: " + head_of(bad));
  }
  require_conforming(mesh);
}

}  // namespace tissue
