#include "tissue/refine/splitting.h"

#include "tissue/refine/blueprint.h"
#include "tissue/refine/numbering.h"
#include "tissue/base/tet_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace {

using namespace tissue;

std::array<Vec3, 10> points_of_reference_tet() {
  std::array<Vec3, 10> x = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  for (int e = 0; e < 6; ++e) x[4 + e] = 0.5 * (x[kTetEdges[e][0]] + x[kTetEdges[e][1]]);
  return x;
}

// Positive tets whose volumes add up to the whole, whose inner faces match and whose outer faces
// are those that the pattern prescribes: such a set is a triangulation.
void expect_splits(const SplitPattern& pattern, const Splitting& splitting) {
  const auto x = points_of_reference_tet();
  double volume = 0.0;
  std::map<std::set<int>, int> faces;
  for (const auto& tet : splitting) {
    const double det = determinant(x[tet[0]], x[tet[1]], x[tet[2]], x[tet[3]]);
    ASSERT_GT(det, 0.0);
    volume += det;
    for (const auto& f : kTetFaces) ++faces[{tet[f[0]], tet[f[1]], tet[f[2]]}];
  }
  EXPECT_NEAR(volume, 1.0, 1e-12);
  for (int face = 0; face < 4; ++face) {
    for (const auto& triangle : face_triangles(pattern, face)) {
      std::set<int> key(triangle.begin(), triangle.end());
      ASSERT_EQ(faces[key], 1);
      faces.erase(key);
    }
  }
  for (const auto& entry : faces) EXPECT_EQ(entry.second, 2);
}

TEST(Splittings, ExistForAllPatternsUnderEveryOrderOfTheEdges) {
  std::set<std::pair<unsigned, std::array<int, 4>>> seen;
  std::size_t cases = 0, most = 0;
  std::array<int, 6> ranks{};
  std::iota(ranks.begin(), ranks.end(), 0);
  do {
    for (unsigned marks = 0; marks < 64; ++marks) {
      ++cases;
      SplitPattern pattern;
      pattern.marks = marks;
      const auto marked = [&](int a, int b) { return (marks >> tet_edge(a, b) & 1u) != 0; };
      for (int face = 0; face < 4; ++face) {
        for (int corner = 0; corner < 3; ++corner) {
          const int z = kTetFaces[face][corner], a = kTetFaces[face][(corner + 1) % 3],
                    b = kTetFaces[face][(corner + 2) % 3];
          if (!marked(z, a) || !marked(z, b) || marked(a, b)) continue;
          pattern.diagonal_start[face] = ranks[tet_edge(z, a)] < ranks[tet_edge(z, b)] ? a : b;
        }
      }
      if (!seen.insert({marks, pattern.diagonal_start}).second) continue;
      const std::vector<Splitting> all = splittings(pattern);
      ASSERT_FALSE(all.empty()) << "marks " << marks;
      for (const Splitting& splitting : all) expect_splits(pattern, splitting);
      most = std::max(most, all.size());
    }
  } while (std::next_permutation(ranks.begin(), ranks.end()));
  EXPECT_EQ(cases, 46080u);
  EXPECT_EQ(most, 3u);
}

TEST(Splittings, DoNotExistForCyclicDiagonals) {
  // Edges 01, 12, 20 and 03, 13, 23 with each corner's comparison pointing around: no order does
  // so.
  SplitPattern pattern;
  pattern.marks = 1u << tet_edge(0, 3) | 1u << tet_edge(1, 3) | 1u << tet_edge(2, 3);
  pattern.diagonal_start = {1, 2, 0, -1};
  EXPECT_TRUE(splittings(pattern).empty());
}

TEST(Numbering, CountsEveryPointOnce) {
  for (const std::uint32_t n : {2u, 4u, 8u, 16u}) {
    std::uint32_t next = 0;
    for (std::uint32_t p = 1; p < n; ++p) {
      for (std::uint32_t q = 1; p + q < n; ++q) EXPECT_EQ(face_index(p, q, n), next++);
    }
    EXPECT_EQ(next, face_points(n));
    next = 0;
    for (std::uint32_t p = 1; p < n; ++p) {
      for (std::uint32_t q = 1; p + q < n; ++q) {
        for (std::uint32_t r = 1; p + q + r < n; ++r) {
          EXPECT_EQ(interior_index(p, q, r, n), next++);
        }
      }
    }
    EXPECT_EQ(next, interior_points_count(n));
  }
}

TEST(InteriorPoints, LieInTheMiddleOfTheirParents) {
  for (int level = 0; level < 5; ++level) {
    for (const InteriorPoint& point : interior_points(level)) {
      int sum = 0;
      for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(2 * point.place[i], point.parents[0][i] + point.parents[1][i]);
        EXPECT_GT(point.place[i], 0);
        sum += point.place[i];
      }
      EXPECT_EQ(sum, 2 << level);
    }
  }
}

}  // namespace
