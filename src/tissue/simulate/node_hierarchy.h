#pragma once

#include "tissue/simulate/finite_elements.h"

namespace tissue {

/// Vertices in the order of a hierarchy of ever finer sets: each set is the beginning of the next.
struct NodeHierarchy {
  /// For each place in the order its vertex, and for each vertex its place.
  std::vector<std::uint32_t> node_at, place_of;
  /// How many vertices each level has, the coarsest first; the last has all.
  std::vector<std::uint32_t> sizes;
  /// For each place behind the coarsest level the two places between which it lies half-way, both
  /// on coarser levels.
  std::vector<Edge> parents;

  /// Of all vertices without parents and those that are made of them. One level if there are none.
  explicit NodeHierarchy(const FiniteElements& elements);
};

}  // namespace tissue
