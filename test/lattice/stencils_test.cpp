#include "tissue/lattice/stencils.h"

#include "tissue/base/quality.h"
#include "tissue/base/tet_mesh.h"
#include "tissue/lattice/bcc_lattice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace tissue;

double length(const BccTet& tet, int a, int b) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) sum += std::pow(tet.corners[a][i] - tet.corners[b][i], 2);
  return std::sqrt(sum);
}

TEST(BccTets, HaveTheirLongEdgesInPlaceAndPositiveVolume) {
  for (const BccTet& tet : bcc_tets()) {
    for (int e = 0; e < 6; ++e) {
      const auto [a, b] = kTetEdges[e];
      EXPECT_NEAR(length(tet, a, b), (a ^ b) == 2 ? 2.0 : std::sqrt(3.0), 1e-12);
      const int start = tet.edges[e].start;
      const auto& step = BccLattice::kStep[tet.edges[e].direction];
      const int end = start == a ? b : a;
      for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(tet.corners[end][i] - tet.corners[start][i], step[i]);
      }
    }
    std::array<Vec3, 4> x;
    for (int i = 0; i < 4; ++i)
      x[i] = Vec3(tet.corners[i][0], tet.corners[i][1], tet.corners[i][2]);
    // a³/12 with a = 2.
    EXPECT_NEAR(determinant(x[0], x[1], x[2], x[3]) / 6.0, 8.0 / 12.0, 1e-12);
  }
}

TEST(BccLattice, FindsNeighboursByArithmetic) {
  BccLattice lattice;
  lattice.size = {7, 8, 9};
  for (int parity = 0; parity < 2; ++parity) {
    const std::int64_t point = lattice.point(3, 4, 5, parity);
    for (const auto& step : BccLattice::kStep) {
      const Vec3 expected = lattice.place(point) + 0.5 * Vec3(step[0], step[1], step[2]);
      EXPECT_LT((lattice.place(point + lattice.offset(parity, step)) - expected).norm(), 1e-12);
    }
  }
}

// The volume that a stencil fills, with every cut in the middle of its edge.
double filled_volume(const BccTet& tet, const std::array<int, 4>& signs) {
  std::array<Vec3, 10> x;
  for (int i = 0; i < 4; ++i) x[i] = Vec3(tet.corners[i][0], tet.corners[i][1], tet.corners[i][2]);
  for (int e = 0; e < 6; ++e) x[4 + e] = 0.5 * (x[kTetEdges[e][0]] + x[kTetEdges[e][1]]);
  const Stencil stencil = fill_tet(signs, tet.corners);
  double volume = 0.0;
  for (int t = 0; t < stencil.count; ++t) {
    const auto& p = stencil.tets[t];
    volume += std::abs(determinant(x[p[0]], x[p[1]], x[p[2]], x[p[3]])) / 6.0;
  }
  return volume;
}

TEST(FillTet, FillsExactlyWhatIsInside) {
  // With cuts at the middles, each outside corner takes an eighth away; two outside corners and two
  // inside leave half; an outside corner next to m corners on the surface takes 1/2^(3 − m).
  for (const BccTet& tet : bcc_tets()) {
    for (int code = 0; code < 81; ++code) {
      std::array<int, 4> signs{};
      int in = 0, on = 0;
      for (int i = 0, rest = code; i < 4; ++i, rest /= 3) {
        signs[i] = rest % 3 - 1;
        in += signs[i] < 0;
        on += signs[i] == 0;
      }
      const int out = 4 - in - on;
      double part = 1.0;
      if (in == 0)
        part = 0.0;
      else if (in == 1)
        part = std::pow(0.5, out);
      else if (out == 1)
        part = 1.0 - std::pow(0.5, in);
      else if (out == 2)
        part = 0.5;
      EXPECT_NEAR(filled_volume(tet, signs), part * 8.0 / 12.0, 1e-12) << "signs " << code;
    }
  }
}

TEST(FillTet, KeepsItsAnglesForCutsAsNearToCornersAsWarpingLeavesThem) {
  // Cuts lie no nearer to an end than 0.285 of a long edge and 0.399 of a short one.
  std::mt19937 random(4);
  DihedralRange worst;
  for (int round = 0; round < 20000; ++round) {
    const BccTet& tet = bcc_tets()[random() % 12];
    std::array<Vec3, 10> x;
    for (int i = 0; i < 4; ++i) {
      x[i] = Vec3(tet.corners[i][0], tet.corners[i][1], tet.corners[i][2]);
    }
    for (int e = 0; e < 6; ++e) {
      const auto [a, b] = kTetEdges[e];
      const double alpha = (a ^ b) == 2 ? 0.285 : 0.399;
      const double t = random() % 2 == 0 ? alpha : 1.0 - alpha;
      x[4 + e] = x[a] + t * (x[b] - x[a]);
    }
    std::array<int, 4> signs{};
    for (int& sign : signs) sign = random() % 2 == 0 ? -1 : 1;
    const Stencil stencil = fill_tet(signs, tet.corners);
    for (int t = 0; t < stencil.count; ++t) {
      const auto& p = stencil.tets[t];
      worst.include(dihedral_range(x[p[0]], x[p[1]], x[p[2]], x[p[3]]));
    }
  }
  EXPECT_GE(worst.min_angle() * 180.0 / M_PI, 10.7);
  EXPECT_LE(worst.max_angle() * 180.0 / M_PI, 164.8);
}

}  // namespace
