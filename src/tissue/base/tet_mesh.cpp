#include "tissue/base/tet_mesh.h"

#include "tissue/base/topology.h"

#include <xxhash.h>

#include <cstdio>

namespace tissue {
namespace {

template <class T>
std::uint64_t hash_of(const std::vector<T>& values, std::uint64_t seed) {
  return XXH64(values.data(), values.size() * sizeof(T), seed);
}

}  // namespace

std::string mesh_uuid(const TetMesh& mesh) {
  std::uint64_t hash = 0;
  hash = hash_of(mesh.vertices, hash);
  hash = hash_of(mesh.tets, hash);
  hash = hash_of(mesh.levels, hash);
  hash = hash_of(mesh.densities, hash);
  hash = hash_of(mesh.tet_densities, hash);
  char text[17];
  std::snprintf(text, sizeof(text), "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

std::vector<Triangle> boundary_of(const std::vector<Tet>& tets, std::size_t vertex_count) {
  const FaceTopology faces = face_topology(tets, vertex_count);
  std::vector<Triangle> boundary;
  for (std::size_t t = 0; t < tets.size(); ++t) {
    for (int f = 0; f < 4; ++f) {
      if (faces.face_tets[faces.tet_faces[t][f]][1] != kNoTet) continue;
      boundary.push_back({tets[t][kOutwardFaces[f][0]], tets[t][kOutwardFaces[f][1]],
                          tets[t][kOutwardFaces[f][2]]});
    }
  }
  return boundary;
}

}  // namespace tissue
