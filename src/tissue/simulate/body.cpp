#include "tissue/simulate/body.h"

#include "tissue/base/check_mesh.h"

#include <algorithm>

namespace tissue {

std::size_t Body::bytes() const {
  return rest.size() * sizeof(Vec3f) + tets.size() * sizeof(Tet) +
         surface.size() * sizeof(Triangle) +
         (densities.size() + tet_densities.size()) * sizeof(float) + parents.size() * sizeof(Edge);
}

Body body_of(const TetMesh& mesh) {
  check_mesh(mesh);
  Body body;
  body.rest = mesh.vertices;
  body.tets = mesh.tets;
  body.surface = mesh.surface.empty() ? boundary_of(mesh.tets, mesh.vertices.size()) : mesh.surface;
  body.densities = mesh.densities;
  body.tet_densities = mesh.tet_densities;
  body.parents = mesh.parents;
  return body;
}

State rest_state(const Body& body) {
  State state;
  state.positions.reserve(body.rest.size());
  for (const Vec3f& place : body.rest) state.positions.push_back(place.cast<double>());
  return state;
}

DeformationQuality deformation_quality(const Body& body, const State& state) {
  DeformationQuality quality;
  for (const Tet& tet : body.tets) {
    const auto& x = state.positions;
    const double det_f = determinant(x, tet) / determinant(body.rest, tet);
    quality.min_det_f = std::min(quality.min_det_f, det_f);
    quality.inverted += det_f <= 0.0;
  }
  return quality;
}

}  // namespace tissue
