#pragma once

#include "tissue/base/types.h"

#include <array>
#include <map>
#include <utility>
#include <vector>

namespace tissue {

/// Point of a tet whose edges may be halved: corner i is i, the midpoint of edge e is 4 + e.
using SplitPoint = std::uint8_t;

/// A tet filled with tets of positive volume on its corners and marked midpoints.
using Splitting = std::vector<std::array<SplitPoint, 4>>;

/// Which edges of a tet are halved, and how its faces are triangulated.
struct SplitPattern {
  /// Bit e is set where edge e is halved.
  unsigned marks = 0;
  /// For each face with exactly two halved edges, the corner from which the diagonal starts; it
  /// ends at the midpoint of the halved edge that the corner is not on. Else −1.
  std::array<int, 4> diagonal_start = {-1, -1, -1, -1};
};

/// Every splitting of the pattern that needs no further point, in a fixed order. There is at least
/// one whenever the diagonals come from a total order of the edges.
std::vector<Splitting> splittings(const SplitPattern& pattern);

/// The splittings of every pattern that was asked for, made once.
class Splittings {
 public:
  const std::vector<Splitting>& of(const SplitPattern& pattern);

 private:
  std::map<std::pair<unsigned, std::array<int, 4>>, std::vector<Splitting>> known_;
};

/// The triangles of one face under the pattern, counter-clockwise seen from outside.
std::vector<std::array<SplitPoint, 3>> face_triangles(const SplitPattern& pattern, int face);

}  // namespace tissue
