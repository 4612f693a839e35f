#pragma once

#include "tissue/base/parallel.h"
#include "tissue/base/quality.h"
#include "tissue/base/tet_mesh.h"

#include <algorithm>
#include <vector>

namespace tissue {

/// Volume inside the boundary, by the divergence theorem: tets from one vertex to every boundary
/// triangle.
inline double volume_inside(const TetMesh& mesh) {
  double sum = 0.0;
  for (const Triangle& triangle : mesh.surface) {
    sum += determinant(mesh.vertices[0], mesh.vertices[triangle[0]], mesh.vertices[triangle[1]],
                       mesh.vertices[triangle[2]]);
  }
  return sum / 6.0;
}

/// Angles of the tets for which `known` says no.
template <class Known>
DihedralRange measured_angles(const TetMesh& mesh, const Run& run, const Known& known) {
  constexpr std::size_t kPiece = 16384;
  std::vector<DihedralRange> ranges((mesh.tets.size() + kPiece - 1) / kPiece);
  parallel_ranges(ranges.size(), 1, run, [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece) {
      const std::size_t last = std::min((piece + 1) * kPiece, mesh.tets.size());
      for (std::size_t t = piece * kPiece; t < last; ++t) {
        if (known(t)) continue;
        const auto corner = [&](int i) -> Vec3 {
          return mesh.vertices[mesh.tets[t][i]].cast<double>();
        };
        ranges[piece].include(dihedral_range(corner(0), corner(1), corner(2), corner(3)));
      }
    }
  });
  DihedralRange range;
  for (const DihedralRange& part : ranges) range.include(part);
  return range;
}

}  // namespace tissue
