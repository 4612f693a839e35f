#pragma once

#include "tissue/base/parallel.h"
#include "tissue/base/quality.h"
#include "tissue/base/tet_mesh.h"
#include "tissue/base/tet_shape.h"

#include <algorithm>
#include <array>
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

/// How many lattice tets have each level.
inline std::vector<std::uint64_t> level_counts(const std::vector<std::uint8_t>& levels) {
  std::vector<std::uint64_t> counts;
  for (const std::uint8_t level : levels) {
    if (level >= counts.size()) counts.resize(level + 1u, 0);
    ++counts[level];
  }
  return counts;
}

/// Angles of the tets for which `known` says no; `unit` is about the length of an edge [m].
template <class Known>
DihedralRange measured_angles(const TetMesh& mesh, double unit, const Run& run,
                              const Known& known) {
  constexpr std::size_t kPiece = 16384;
  std::vector<DihedralRange> ranges((mesh.tets.size() + kPiece - 1) / kPiece);
  parallel_ranges(ranges.size(), 1, run, [&](std::size_t begin, std::size_t end) {
    TetBatch batch(unit);
    std::array<float, TetBatch::kCapacity> lowest, highest;
    for (std::size_t piece = begin; piece < end; ++piece) {
      const auto measure = [&] {
        batch.measure(lowest.data(), highest.data());
        for (int i = 0; i < batch.count(); ++i) ranges[piece].include({lowest[i], highest[i]});
        batch.clear();
      };
      const std::size_t last = std::min((piece + 1) * kPiece, mesh.tets.size());
      for (std::size_t t = piece * kPiece; t < last; ++t) {
        if (known(t)) continue;
        const Tet& tet = mesh.tets[t];
        batch.add(mesh.vertices[tet[0]], mesh.vertices[tet[1]], mesh.vertices[tet[2]],
                  mesh.vertices[tet[3]]);
        if (batch.count() == TetBatch::kCapacity) measure();
      }
      measure();
    }
  });
  DihedralRange range;
  for (const DihedralRange& part : ranges) range.include(part);
  return range;
}

}  // namespace tissue
