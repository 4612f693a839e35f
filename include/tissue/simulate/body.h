#pragma once

#include "tissue/base/tet_mesh.h"

namespace tissue {

/// What a simulation never changes.
struct Body {
  /// Rest positions [m].
  std::vector<Vec3f> rest;
  std::vector<Tet> tets;
  std::vector<Triangle> surface;
  /// At the vertices.
  std::vector<float> densities;
  /// Mean over each tet; empty where the mesh does not say.
  std::vector<float> tet_densities;
  /// For each of the last vertices the ends of the edge that it halves; empty for a mesh without a
  /// hierarchy.
  std::vector<Edge> parents = {};

  std::size_t bytes() const;
};

/// Throws InputError as check_mesh does.
Body body_of(const TetMesh& mesh);

/// A place in the material: barycentric coordinates in a tet.
struct TetPlace {
  std::uint32_t tet = 0;
  std::array<double, 4> barycentric = {0.25, 0.25, 0.25, 0.25};
};

/// What a simulation moves.
struct State {
  /// Deformed positions [m], in the order of the rest positions.
  std::vector<Vec3> positions;
  /// Of the vertices [m/s]; empty where nothing has inertia.
  std::vector<Vec3> velocities = {};
};

/// At rest, to the last bit.
State rest_state(const Body& body);

/// How far a state is from being invalid: F maps a tet's rest edges to its deformed ones.
struct DeformationQuality {
  double min_det_f = 1.0;
  std::size_t inverted = 0;
};
DeformationQuality deformation_quality(const Body& body, const State& state);

}  // namespace tissue
