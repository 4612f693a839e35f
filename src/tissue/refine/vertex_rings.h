#pragma once

#include "tissue/base/run.h"
#include "tissue/base/types.h"

#include <vector>

namespace tissue {

/// The tets around each of some vertices, and these vertices by colour: two of one colour share no
/// tet.
struct VertexRings {
  /// Ascending.
  std::vector<std::uint32_t> vertices;
  /// The ring of vertices[i] is tets[begin[i]] to tets[begin[i + 1] − 1].
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> tets;
  /// For every colour the indices into `vertices`, ascending.
  std::vector<std::vector<std::uint32_t>> colours;
};

VertexRings vertex_rings(std::vector<std::uint32_t> vertices, const std::vector<Tet>& all_tets,
                         std::size_t vertex_count, const Run& run);

}  // namespace tissue
