#pragma once

#include "tissue/base/mesh_statistics.h"
#include "tissue/base/types.h"

#include <string>
#include <vector>

namespace tissue {

/// A conforming tetrahedral mesh of an organ, as it is published: flat arrays, SI units.
struct TetMesh {
  /// Positions [m] in `frame_id`. The first `lattice_vertices` belong to the uniform stage.
  std::vector<Vec3f> vertices;
  std::vector<Tet> tets;
  /// Refinement level of each tet's lattice tet.
  std::vector<std::uint8_t> levels;
  /// Density at each vertex, in (0, d_max].
  std::vector<float> densities;
  /// Mean density over each tet, by sampling the volume: what stiffness is taken from.
  std::vector<float> tet_densities;
  /// Boundary triangles, outward.
  std::vector<Triangle> surface;
  /// For each vertex after the lattice's: the ends of the edge that it halves. Empty for a mesh
  /// without a hierarchy.
  std::vector<Edge> parents;
  std::uint32_t lattice_vertices = 0;
  std::string frame_id = "patient";
  /// Hash of geometry, levels and densities: the same mesh has the same uuid.
  std::string uuid;
  MeshStatistics statistics;
};

/// 16 hexadecimal digits from the bytes of vertices, tets, levels and densities.
std::string mesh_uuid(const TetMesh& mesh);

/// The triangles that belong to one tet only, outward, in the order of the tets.
std::vector<Triangle> boundary_of(const std::vector<Tet>& tets, std::size_t vertex_count);

/// Six times the signed volume, in double whatever the positions are stored in.
template <class Position>
double determinant(const Position& a, const Position& b, const Position& c, const Position& d) {
  const Vec3 origin = a.template cast<double>();
  return (b.template cast<double>() - origin)
      .cross(c.template cast<double>() - origin)
      .dot(d.template cast<double>() - origin);
}
template <class Position>
double determinant(const std::vector<Position>& vertices, const Tet& tet) {
  return determinant(vertices[tet[0]], vertices[tet[1]], vertices[tet[2]], vertices[tet[3]]);
}

}  // namespace tissue
