#include "blueprint.h"

#include "numbering.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <map>
#include <tuple>

namespace tissue {
namespace {

using Corners = std::array<Barycentric, 4>;

Barycentric midpoint(const Barycentric& a, const Barycentric& b) {
  Barycentric result{};
  for (int i = 0; i < 4; ++i) result[i] = (a[i] + b[i]) / 2;
  return result;
}

Barycentric difference(const Barycentric& a, const Barycentric& b) {
  Barycentric result{};
  for (int i = 0; i < 4; ++i) result[i] = a[i] - b[i];
  return result;
}

bool is_positive(const Corners& c) {
  // The orientation shows in the last three coordinates alone.
  long m[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) m[i][j] = c[i + 1][j + 1] - c[0][j + 1];
  }
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) >
         0;
}

Corners whole_tet(int level) {
  Corners corners{};
  for (int i = 0; i < 4; ++i) corners[i][i] = 2 << level;
  return corners;
}

// The eight children in Bey's order. Their corners continue the order of their parent's; swapping
// corners 0 and 2 turns a child around without changing which edges are long.
std::array<Corners, 8> children(const Corners& x) {
  const Barycentric x01 = midpoint(x[0], x[1]), x02 = midpoint(x[0], x[2]),
                    x03 = midpoint(x[0], x[3]), x12 = midpoint(x[1], x[2]),
                    x13 = midpoint(x[1], x[3]), x23 = midpoint(x[2], x[3]);
  std::array<Corners, 8> result = {{{x[0], x01, x02, x03},
                                    {x01, x[1], x12, x13},
                                    {x02, x12, x[2], x23},
                                    {x03, x13, x23, x[3]},
                                    {x01, x02, x03, x13},
                                    {x01, x02, x12, x13},
                                    {x02, x03, x13, x23},
                                    {x02, x12, x13, x23}}};
  for (Corners& child : result) {
    if (!is_positive(child)) std::swap(child[0], child[2]);
  }
  return result;
}

template <class Visit>
void refine_red(const Corners& tet, int times, const Visit& visit) {
  visit(tet, times);
  if (times == 0) return;
  for (const Corners& child : children(tet)) refine_red(child, times - 1, visit);
}

// Whether an edge of a part lies on a lattice edge or face with one level more than the tet.
bool is_halved(const TemplateKey& key, const Barycentric& a, const Barycentric& b) {
  std::array<int, 4> used{};
  int count = 0;
  for (int i = 0; i < 4; ++i) {
    if (a[i] != 0 || b[i] != 0) used[count++] = i;
  }
  if (count == 2) return (key.finer_edges >> tet_edge(used[0], used[1]) & 1u) != 0;
  if (count == 3) return (key.finer_faces >> (6 - used[0] - used[1] - used[2]) & 1u) != 0;
  return false;
}

// The lattice edge that a halved edge of a part is parallel to.
int lattice_direction(const Barycentric& a, const Barycentric& b) {
  std::array<int, 4> changed{};
  int count = 0;
  for (int i = 0; i < 4; ++i) {
    if (a[i] != b[i]) changed[count++] = i;
  }
  assert(count == 2 && "halved edges lie in faces of the lattice tet");
  return tet_edge(changed[0], changed[1]);
}

// A total order of the six lattice edges that agrees with every comparison in the key.
std::array<int, 6> edge_ranks(const TemplateKey& key) {
  std::array<unsigned, 6> before{};
  const unsigned deciding = key.deciding_corners();
  for (int face = 0; face < 4; ++face) {
    for (int corner = 0; corner < 3; ++corner) {
      if ((deciding >> (3 * face + corner) & 1u) == 0) continue;
      const int z = kTetFaces[face][corner];
      const int lower = tet_edge(z, kTetFaces[face][corner == 0 ? 1 : 0]);
      const int upper = tet_edge(z, kTetFaces[face][corner == 2 ? 1 : 2]);
      const bool lower_first = (key.first_edges >> (3 * face + corner) & 1u) != 0;
      before[lower_first ? upper : lower] |= 1u << (lower_first ? lower : upper);
    }
  }
  std::array<int, 6> ranks{};
  unsigned placed = 0;
  for (int rank = 0; rank < 6; ++rank) {
    int edge = 0;
    while (edge < 6 && ((placed >> edge & 1u) != 0 || (before[edge] & ~placed) != 0)) ++edge;
    assert(edge < 6 && "comparisons that come from one order have no cycle");
    ranks[edge] = rank;
    placed |= 1u << edge;
  }
  return ranks;
}

SplitPattern pattern_of(const TemplateKey& key, const std::array<int, 6>& ranks,
                        const Corners& part) {
  SplitPattern pattern;
  for (int e = 0; e < 6; ++e) {
    if (is_halved(key, part[kTetEdges[e][0]], part[kTetEdges[e][1]])) pattern.marks |= 1u << e;
  }
  for (int face = 0; face < 4; ++face) {
    for (int corner = 0; corner < 3; ++corner) {
      const int z = kTetFaces[face][corner];
      const int a = kTetFaces[face][(corner + 1) % 3], b = kTetFaces[face][(corner + 2) % 3];
      const auto halved = [&](int i, int j) { return (pattern.marks >> tet_edge(i, j) & 1u) != 0; };
      if (!halved(z, a) || !halved(z, b) || halved(a, b)) continue;
      const bool a_first =
          ranks[lattice_direction(part[z], part[a])] < ranks[lattice_direction(part[z], part[b])];
      pattern.diagonal_start[face] = a_first ? a : b;
    }
  }
  return pattern;
}

// Whether both edges of a face at one of its corners are among these.
bool both_finer(unsigned finer_edges, int face, int corner) {
  const int z = kTetFaces[face][corner];
  for (const int other : kTetFaces[face]) {
    if (other != z && (finer_edges >> tet_edge(z, other) & 1u) == 0) return false;
  }
  return true;
}

}  // namespace

unsigned TemplateKey::deciding_corners() const {
  // By whether the level is above 0, and the finer edges.
  static const auto table = [] {
    std::array<std::array<unsigned, 64>, 2> result{};
    for (unsigned edges = 0; edges < 64; ++edges) {
      for (int face = 0; face < 4; ++face) {
        for (int corner = 0; corner < 3; ++corner) {
          if (!both_finer(edges, face, corner)) continue;
          const unsigned bit = 1u << (3 * face + corner);
          result[1][edges] |= bit;
          // At level 0 a face with three halved edges is split into four triangles without a
          // diagonal.
          if (!both_finer(edges, face, (corner + 1) % 3)) result[0][edges] |= bit;
        }
      }
    }
    return result;
  }();
  unsigned corners = table[level > 0][finer_edges];
  for (int face = 0; face < 4; ++face) {
    if ((finer_faces >> face & 1u) != 0) corners &= ~(7u << 3 * face);
  }
  return corners;
}

Blueprint make_blueprint(const TemplateKey& key, Splittings& splittings) {
  Blueprint blueprint;
  blueprint.key = key;
  const std::array<int, 6> ranks = edge_ranks(key);
  using ShapeKey = std::tuple<std::array<Barycentric, 3>, unsigned, std::array<int, 4>>;
  std::map<ShapeKey, int> known;
  for (const Corners& corners : red_refined(key.level)) {
    const SplitPattern pattern = pattern_of(key, ranks, corners);
    const std::array<Barycentric, 3> steps = {difference(corners[1], corners[0]),
                                              difference(corners[2], corners[0]),
                                              difference(corners[3], corners[0])};
    const auto [entry, is_new] =
        known.emplace(ShapeKey(steps, pattern.marks, pattern.diagonal_start),
                      static_cast<int>(blueprint.shapes.size()));
    if (is_new) {
      blueprint.shapes.push_back({steps, pattern, &splittings.of(pattern)});
      assert(!blueprint.shapes.back().splittings->empty());
    }
    blueprint.parts.push_back({corners, entry->second});
  }
  return blueprint;
}

std::vector<Corners> red_refined(int level) {
  std::vector<Corners> parts;
  refine_red(whole_tet(level), level, [&](const Corners& tet, int left) {
    if (left == 0) parts.push_back(tet);
  });
  return parts;
}

std::vector<InteriorPoint> interior_points(int level) {
  const auto n = std::uint32_t{1} << level;
  std::vector<InteriorPoint> points(interior_points_count(n));
  refine_red(whole_tet(level), level, [&](const Corners& tet, int left) {
    if (left == 0) return;
    for (const auto& ends : kTetEdges) {
      const Barycentric place = midpoint(tet[ends[0]], tet[ends[1]]);
      if (*std::min_element(place.begin(), place.end()) == 0) continue;
      const auto part = [&](int i) { return static_cast<std::uint32_t>(place[i]) / 2; };
      points[interior_index(part(1), part(2), part(3), n)] = {place, {tet[ends[0]], tet[ends[1]]}};
    }
  });
  return points;
}

}  // namespace tissue
