#pragma once

#include "tissue/simulate/finite_elements.h"

namespace tissue {

/// How what is known at the nodes of a coarser level gives what is at those of a finer one: each
/// fine node is a mean of a few coarse ones, its parents.
struct Coarsening {
  std::uint32_t coarse_size = 0, fine_size = 0;
  /// Whether the coarse nodes are the first of the fine ones, and their own parents; the others
  /// follow.
  bool nested = true;
  std::vector<std::uint32_t> begin = {0}, parents;
  std::vector<float> weights;

  /// Calls body(coarse, weight) for each parent of a fine node.
  template <class Body>
  void for_parents(std::uint32_t fine, const Body& body) const {
    if (nested && fine < coarse_size) {
      body(fine, 1.0f);
      return;
    }
    const std::uint32_t i = nested ? fine - coarse_size : fine;
    for (std::uint32_t k = begin[i]; k < begin[i + 1]; ++k) body(parents[k], weights[k]);
  }
  void add(std::uint32_t parent, float weight) {
    parents.push_back(parent);
    weights.push_back(weight);
  }
  /// After the last parent of a fine node.
  void end_node() { begin.push_back(static_cast<std::uint32_t>(parents.size())); }
};

/// A body's vertices and ever coarser levels below them: sets of vertices from which the others
/// were made by halving edges, and where there is none that is small, lattices laid over the body.
struct NodeHierarchy {
  /// For each place in the finest level's order its vertex, and for each vertex its place.
  std::vector<std::uint32_t> node_at, place_of;
  /// The coarsest first; none where all is small.
  std::vector<Coarsening> steps;

  explicit NodeHierarchy(const FiniteElements& elements);

 private:
  void add_lattices(const FiniteElements& elements, std::vector<Vec3> points);
};

}  // namespace tissue
