#pragma once

#include "tissue/base/parallel.h"
#include "tissue/base/types.h"
#include "tissue/refine/project_boundary.h"

#include <vector>

namespace tissue {

/// The tets around each of some vertices, and these vertices in blocks that may be worked on at the
/// same time.
struct VertexRings {
  /// Ascending.
  std::vector<std::uint32_t> vertices;
  /// The ring of vertices[i] is tets[begin[i]] to tets[begin[i + 1] − 1].
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> tets;
  /// Indices into `vertices`, from first to last − 1: neighbours in memory and mostly in space.
  struct Block {
    std::uint32_t first, last;
  };
  /// For every colour its blocks, ascending: vertices of two of them share no tet.
  std::vector<std::vector<Block>> colours;

  /// Calls `body(begin, end)` for the indices of every block. Blocks of one colour run at the same
  /// time, colours one after the other.
  template <class Body>
  void for_each_block(const Run& run, const Body& body) const {
    for (const std::vector<Block>& blocks : colours) {
      parallel_ranges(blocks.size(), 1, run, [&](std::size_t from, std::size_t to) {
        for (std::size_t b = from; b < to; ++b) body(blocks[b].first, blocks[b].last);
      });
    }
  }
};

/// Looks for tets in `where` alone.
VertexRings vertex_rings(std::vector<std::uint32_t> vertices, const std::vector<Tet>& all_tets,
                         const std::vector<TetRange>& where, std::size_t vertex_count,
                         const Run& run);

}  // namespace tissue
