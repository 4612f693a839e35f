#include "tissue/base/topology.h"

#include "support/mesh_checks.h"
#include "tissue/base/quality.h"
#include "tissue/base/tet_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace tissue;

const std::vector<Tet> kTwoTets = {{0, 1, 2, 3}, {3, 2, 1, 4}};

TEST(FaceTopology, JoinsTetsAtTheirCommonFace) {
  const FaceTopology faces = face_topology(kTwoTets, 5);
  EXPECT_EQ(faces.face_tets.size(), 7u);
  // Opposite vertex 0 in one tet and vertex 4 in the other.
  const std::uint32_t common = faces.tet_faces[0][0];
  EXPECT_EQ(common, faces.tet_faces[1][3]);
  EXPECT_EQ(faces.face_tets[common], (std::array<std::uint32_t, 2>{0, 1}));
  EXPECT_EQ(faces.face_tets[faces.tet_faces[0][1]][1], kNoTet);
}

TEST(FaceTopology, S6_RefusesAThirdTetAtAFace) {
  const std::string text = tissue_test::refusal([] {
    face_topology({{0, 1, 2, 3}, {3, 2, 1, 4}, {1, 2, 3, 5}}, 6);
  });
  EXPECT_EQ(text, "E_CONFORMITY: face_topology: tet 2 is the third at face 1 2 3");
}

TEST(EdgeTopology, GivesCommonEdgesOneNumber) {
  const EdgeTopology edges = edge_topology(kTwoTets, 5);
  EXPECT_EQ(edges.edges.size(), 9u);
  EXPECT_EQ(edges.tet_edges[0][tet_edge(1, 2)], edges.tet_edges[1][tet_edge(1, 2)]);
  EXPECT_EQ(edges.edges[edges.tet_edges[1][tet_edge(0, 3)]], (Edge{3, 4}));
}

TEST(DihedralRange, KnowsTheRegularTetAndTheCornerOfACube) {
  const DihedralRange regular = dihedral_range({1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1});
  EXPECT_NEAR(regular.min_angle(), std::acos(1.0 / 3.0), 1e-12);
  EXPECT_NEAR(regular.max_angle(), std::acos(1.0 / 3.0), 1e-12);
  const DihedralRange corner = dihedral_range({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  EXPECT_NEAR(corner.max_angle(), M_PI / 2.0, 1e-12);
  EXPECT_NEAR(corner.min_angle(), std::acos(std::sqrt(1.0 / 3.0)), 1e-12);
}

TEST(DihedralRange, GivesAFlatTetBothExtremes) {
  const DihedralRange flat = dihedral_range({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0});
  EXPECT_EQ(flat.min_angle(), 0.0);
  EXPECT_NEAR(flat.max_angle(), M_PI, 1e-12);
}

TEST(TetBatch, MeasuresAnglesAsOneByOneInDoublePrecision) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-0.002, 0.002);
  TetBatch batch(0.003);
  std::vector<DihedralRange> expected;
  for (int i = 0; i < TetBatch::kCapacity - 1; ++i) {
    std::array<Vec3, 4> corners;
    for (Vec3& corner : corners)
      corner = {uniform(generator), uniform(generator), uniform(generator)};
    batch.add(corners[0], corners[1], corners[2], corners[3]);
    expected.push_back(dihedral_range(corners[0], corners[1], corners[2], corners[3]));
  }
  const Vec3 place(0.001, 0.001, 0.001);
  batch.add(place, place, place, place);
  expected.push_back({-1.0, 1.0});
  std::array<float, TetBatch::kCapacity> lowest, highest;
  batch.measure(lowest.data(), highest.data());
  for (int i = 0; i < batch.count(); ++i) {
    EXPECT_NEAR(lowest[i], expected[i].lowest, 1e-4) << i;
    EXPECT_NEAR(highest[i], expected[i].highest, 1e-4) << i;
  }
}

}  // namespace
