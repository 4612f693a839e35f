#pragma once

#include "splitting.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tissue {

/// Whole barycentric coordinates in a lattice tet; at level l they add up to 2^(l+1), so that the
/// midpoints that closure may add are whole too.
using Barycentric = std::array<int, 4>;

/// All that decides how a lattice tet is filled, but for the choice among equal splittings.
struct TemplateKey {
  int level = 0;
  /// Bit e: the lattice edge e has one level more than the tet.
  unsigned finer_edges = 0;
  /// Bit f: the lattice face f has one level more than the tet.
  unsigned finer_faces = 0;
  /// Bit 3f + c: of the two edges of face f at its corner c, the one to the lower other corner
  /// comes first in the order of edges. Set only where the comparison decides a diagonal.
  unsigned first_edges = 0;

  std::uint32_t packed() const {
    return static_cast<std::uint32_t>(level) << 22 | finer_edges << 16 | finer_faces << 12 |
           first_edges;
  }
  /// Bit 3f + c: whether that comparison decides a diagonal.
  unsigned deciding_corners() const;
};

/// The 8^level parts of a lattice tet and the ways to close each of them.
struct Blueprint {
  /// A part; its corners are in the order in which refinement goes on.
  struct Part {
    std::array<Barycentric, 4> corners;
    int shape;
  };
  /// What parts that are alike (the same but for their place) have in common.
  struct Shape {
    /// From corner 0 to corners 1, 2, 3.
    std::array<Barycentric, 3> steps;
    SplitPattern pattern;
    const std::vector<Splitting>* splittings;
  };
  TemplateKey key;
  std::vector<Part> parts;
  std::vector<Shape> shapes;
};

/// The splittings live in `known`.
Blueprint make_blueprint(const TemplateKey& key, Splittings& known);

/// A point of the interior of a tet refined `level` times and the ends of the edge that it halves.
struct InteriorPoint {
  Barycentric place;
  std::array<Barycentric, 2> parents;
};

/// In the order of interior_index(); coordinates add up to 2^(level+1).
std::vector<InteriorPoint> interior_points(int level);

/// Bey's red refinement, again and again: parts keep the order of corners that bounds their angles.
std::vector<std::array<Barycentric, 4>> red_refined(int level);

}  // namespace tissue
