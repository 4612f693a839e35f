#include "support/mesh_checks.h"

#include "tissue/base/check_mesh.h"

#include <limits>

namespace {

using tissue::TetMesh;
using tissue_test::refusal;

// Two tets that share a face.
TetMesh two_tets() {
  TetMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  mesh.levels = {0, 0};
  mesh.densities = {1, 2, 3, 4, 5};
  mesh.tet_densities = {1, 2};
  mesh.lattice_vertices = 5;
  mesh.surface = tissue::boundary_of(mesh.tets, mesh.vertices.size());
  return mesh;
}

TEST(CheckMesh, AcceptsTwoTetsThatShareAFace) {
  EXPECT_EQ(refusal([] { check_mesh(two_tets()); }), "");
}

TEST(CheckMesh, RefusesArraysThatDisagree) {
  TetMesh mesh = two_tets();
  mesh.levels.pop_back();
  EXPECT_EQ(refusal([&] { check_mesh(mesh); }),
            "E_SIZE_MISMATCH: mesh: levels has 1 entries, not 2");
  mesh = two_tets();
  mesh.tets[1][3] = 5;
  EXPECT_EQ(refusal([&] { check_mesh(mesh); }),
            "E_SIZE_MISMATCH: mesh: tetrahedra[1] names vertex 5 of 5");
}

TEST(CheckMesh, RefusesPositionsAndDensitiesThatAreNotFinite) {
  TetMesh mesh = two_tets();
  mesh.vertices[2].y() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refusal([&] { check_mesh(mesh); }), "E_NONFINITE: mesh: vertices[2] is not finite");
  mesh = two_tets();
  mesh.densities[3] = 0.0f;
  EXPECT_EQ(refusal([&] { check_mesh(mesh); }), "E_PARAM: mesh: densities[3] is 0");
}

TEST(CheckMesh, S1_RefusesInvertedTets) {
  TetMesh mesh = two_tets();
  std::swap(mesh.tets[1][0], mesh.tets[1][1]);
  EXPECT_EQ(refusal([&] { check_mesh(mesh); }),
            "E_MESH_QUALITY: mesh: 1 tets are flat or inverted: 1");
}

TEST(CheckMesh, RefusesAFaceOfThreeTets) {
  TetMesh mesh = two_tets();
  mesh.vertices.push_back({2, 2, 2});
  mesh.densities.push_back(1);
  mesh.tets.push_back({1, 2, 3, 5});
  mesh.levels.push_back(0);
  mesh.tet_densities.push_back(1);
  EXPECT_NE(refusal([&] { check_mesh(mesh); }).find("E_CONFORMITY"), std::string::npos);
}

TEST(CheckMesh, S1_T16_CountsFlatTetsAndThoseWithACornerTwiceAndListsTheFirst) {
  TetMesh mesh = two_tets();
  const tissue::Tet good = mesh.tets[0];
  for (int i = 0; i < 7; ++i) {
    mesh.tets.push_back({good[0], good[1], good[2], good[2]});
    mesh.levels.push_back(0);
    mesh.tet_densities.push_back(1);
  }
  EXPECT_EQ(refusal([&] { check_mesh(mesh); }),
            "E_MESH_QUALITY: mesh: 7 tets are flat or inverted: 2, 3, 4, 5, 6, …");
  // Four corners in a plane, as exactly as single precision has it.
  mesh = two_tets();
  mesh.vertices.push_back(0.5f * (mesh.vertices[0] + mesh.vertices[1]));
  mesh.densities.push_back(1);
  mesh.tets.push_back({0, 1, 2, 5});
  mesh.levels.push_back(0);
  mesh.tet_densities.push_back(1);
  EXPECT_EQ(refusal([&] { check_mesh(mesh); }),
            "E_MESH_QUALITY: mesh: 1 tets are flat or inverted: 2");
}

TEST(CheckMesh, S6_RefusesAHangingNode) {
  // Two tets share a face in place, but one side of it is split at the middle of an edge.
  TetMesh mesh;
  mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {0, 0, -2}, {1, 0, 0}};
  mesh.tets = {{0, 1, 2, 3}, {0, 2, 5, 4}, {5, 2, 1, 4}};
  mesh.levels = {0, 0, 0};
  mesh.densities.assign(6, 1.0f);
  mesh.tet_densities.assign(3, 1.0f);
  EXPECT_EQ(refusal([&] { check_mesh(mesh); }).substr(0, 40),
            "E_CONFORMITY: mesh: 1 vertices hang in t");
  // The same with both sides split is fine.
  mesh.tets = {{0, 5, 2, 3}, {5, 1, 2, 3}, {0, 2, 5, 4}, {5, 2, 1, 4}};
  mesh.levels.push_back(0);
  mesh.tet_densities.push_back(1.0f);
  EXPECT_NO_THROW(check_mesh(mesh));
}

TEST(CheckMesh, S6_RefusesTetsThatMeetInOneVertexOrOneEdgeOnly) {
  TetMesh mesh = two_tets();
  mesh.vertices.insert(mesh.vertices.end(), {{2, 1, 1}, {1, 2, 1}, {1, 1, 2}});
  mesh.densities.assign(mesh.vertices.size(), 1.0f);
  mesh.tets.push_back({4, 5, 6, 7});
  mesh.levels.push_back(0);
  mesh.tet_densities.push_back(1.0f);
  EXPECT_EQ(refusal([&] { check_mesh(mesh); }),
            "E_CONFORMITY: mesh: 1 vertices where the boundary is no manifold: vertices 4");
  mesh = tissue::TetMesh();
  mesh.vertices = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  mesh.densities.assign(6, 1.0f);
  mesh.tets = {{0, 2, 3, 1}, {0, 4, 5, 1}};
  mesh.levels = {0, 0};
  mesh.tet_densities = {1.0f, 1.0f};
  EXPECT_EQ(refusal([&] { check_mesh(mesh); }),
            "E_CONFORMITY: mesh: 2 vertices where the boundary is no manifold: vertices 0, 1");
}

TEST(Inspect, SeesACrackAPinchAndAHangingNode) {
  TetMesh mesh = two_tets();
  mesh.parents = {{0, 1}};
  mesh.lattice_vertices = 4;
  EXPECT_EQ(tissue_test::inspect(mesh).hanging_nodes, 1u);
  // A third tet that touches the first two in one vertex only.
  mesh = two_tets();
  mesh.vertices.insert(mesh.vertices.end(), {{2, 1, 1}, {1, 2, 1}, {1, 1, 2}});
  mesh.tets.push_back({4, 5, 6, 7});
  const tissue_test::MeshFindings found = tissue_test::inspect(mesh);
  EXPECT_EQ(found.pinched_vertices, 1u);
  EXPECT_TRUE(found.surface_differs);
}

TEST(MeshUuid, ChangesWithEveryPartOfTheMesh) {
  const std::string uuid = mesh_uuid(two_tets());
  EXPECT_EQ(uuid.size(), 16u);
  EXPECT_EQ(uuid, mesh_uuid(two_tets()));
  TetMesh mesh = two_tets();
  mesh.levels[0] = 1;
  EXPECT_NE(uuid, mesh_uuid(mesh));
  mesh = two_tets();
  mesh.densities[0] = 7;
  EXPECT_NE(uuid, mesh_uuid(mesh));
  mesh = two_tets();
  mesh.vertices[0].x() = 0.5f;
  EXPECT_NE(uuid, mesh_uuid(mesh));
}

}  // namespace
