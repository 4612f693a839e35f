#include "tissue/base/check_mesh.h"

#include "tissue/base/error.h"
#include "tissue/base/topology.h"

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
  std::size_t bad = 0, first = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& tet = mesh.tets[t];
    if (determinant(mesh.vertices[tet[0]], mesh.vertices[tet[1]], mesh.vertices[tet[2]],
                    mesh.vertices[tet[3]]) > 0.0) {
      continue;
    }
    if (bad++ == 0) first = t;
  }
  if (bad > 0) {
    throw InputError(ErrorCode::kMeshQuality, "mesh: " + std::to_string(bad) +
                                                  " tets are flat or inverted, the first is " +
                                                  std::to_string(first));
  }
  face_topology(mesh.tets, vertices);
}

}  // namespace tissue
