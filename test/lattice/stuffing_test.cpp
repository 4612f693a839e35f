#include "tissue/lattice/stuffing.h"

#include "support/mesh_checks.h"
#include "support/shapes.h"
#include "tissue/base/tet_mesh.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace {

using namespace tissue;
using tissue_test::refusal;
using tissue_test::Shape;

TetMesh as_mesh(const LatticeMesh& lattice) {
  TetMesh mesh;
  for (const Vec3& vertex : lattice.vertices) mesh.vertices.push_back(vertex.cast<float>());
  mesh.tets = lattice.tets;
  mesh.surface = boundary_of(mesh.tets, mesh.vertices.size());
  return mesh;
}

void expect_sound(const LatticeMesh& lattice) {
  const tissue_test::MeshFindings found =
      tissue_test::expect_sound(as_mesh(lattice), lattice.vertices_copied);
  // The bounds of isosurface stuffing for every input.
  EXPECT_GE(found.min_dihedral_deg, 10.7);
  EXPECT_LE(found.max_dihedral_deg, 164.8);
}

LatticeMesh stuffed(const Shape& shape, double spacing, bool all = false) {
  StuffingOptions options;
  options.spacing = spacing;
  if (all) options.component.choice = Component::Choice::kAll;
  return stuff(surface_at_iso(shape.volume, shape.iso), options);
}

TEST(Stuff, KeepsItsAnglesAndIsAManifoldOnEverySyntheticShape) {
  for (const Shape& shape : tissue_test::synthetic_shapes()) {
    for (const double spacing : {0.003, 0.0041, 0.0057}) {
      SCOPED_TRACE(shape.name + " at " + std::to_string(spacing));
      expect_sound(stuffed(shape, spacing));
    }
  }
}

TEST(Stuff, KeepsItsAnglesAndIsAManifoldOnRealVolumes) {
  for (const Shape& shape : tissue_test::real_volumes()) {
    SCOPED_TRACE(shape.name);
    expect_sound(stuffed(shape, 0.0065));
  }
}

TEST(Stuff, FillsTheVolumeOfABall) {
  const Shape ball = tissue_test::synthetic_shapes()[0];
  const TetMesh mesh = as_mesh(stuffed(ball, 0.002));
  const double expected = 4.0 / 3.0 * M_PI * std::pow(24.3e-3, 3);
  // Flat facets cut a sphere short by the order of (spacing/radius)².
  EXPECT_NEAR(tissue_test::inspect(mesh).tet_volume, expected, 0.01 * expected);
}

TEST(Stuff, PutsBoundaryVerticesOntoTheSurface) {
  const LatticeMesh lattice = stuffed(tissue_test::synthetic_shapes()[0], 0.004);
  for (const Triangle& triangle : as_mesh(lattice).surface) {
    for (const std::uint32_t v : triangle) {
      const double radius = (lattice.vertices[v] - Vec3::Constant(31.5e-3)).norm();
      // What the trilinear field differs from the ball by.
      ASSERT_NEAR(radius, 24.3e-3, 0.02e-3);
    }
  }
}

TEST(Stuff, SplitsTwoBallsThatTouchAndKeepsOneOrBoth) {
  const Shape balls = tissue_test::synthetic_shapes()[3];
  const LatticeMesh one = stuffed(balls, 0.0037);
  const LatticeMesh both = stuffed(balls, 0.0037, true);
  expect_sound(both);
  if (one.components_dropped > 0) {
    EXPECT_GT(both.tets.size(), one.tets.size());
  } else {
    EXPECT_EQ(both.tets.size(), one.tets.size());
  }
}

TEST(Stuff, V8_ClosesAnOrganAtTheBorderWithAFlatCap) {
  const auto solid = tissue_test::byte_volume(20, [](double, double, double) { return 200.0; });
  const LatticeMesh lattice = stuffed({"solid", solid, 100.0}, 0.003);
  expect_sound(lattice);
  EXPECT_TRUE(lattice.border_touched);
  // 20 voxels of 1 mm along every side, but for edges that the lattice cuts off.
  EXPECT_NEAR(tissue_test::inspect(as_mesh(lattice)).tet_volume, 8e-6, 0.4e-6);
  EXPECT_FALSE(stuffed(tissue_test::synthetic_shapes()[0], 0.004).border_touched);
}

TEST(Stuff, V9_NamesASpacingThatWouldDoAndKeepsItsWord) {
  const auto voxel = tissue_test::byte_volume(1, [](double, double, double) { return 200.0; });
  const auto pair = tissue_test::byte_volume(2, [](double, double, double) { return 200.0; });
  const auto sheet = tissue_test::byte_volume(
      24, [](double, double, double z) { return z == 11.0 ? 200.0 : 0.0; });
  const auto dot = tissue_test::byte_volume(24, [](double x, double y, double z) {
    return x == 7.0 && y == 8.0 && z == 9.0 ? 200.0 : 0.0;
  });
  for (const auto& volume : {voxel, pair, sheet, dot}) {
    const Shape shape = {"small", volume, 100.0};
    const std::string text = refusal([&] { stuffed(shape, 0.01); });
    ASSERT_EQ(text.substr(0, 11), "E_TOO_SMALL") << text;
    double would_do = 0.0;
    ASSERT_EQ(std::sscanf(text.c_str() + text.find("lattice; "), "lattice; %lf m", &would_do), 1);
    expect_sound(stuffed(shape, would_do));
  }
}

TEST(Stuff, V13_KeepsTheLargestOfManyComponents) {
  // Loose voxels of noise around a ball.
  std::mt19937 random(1);
  std::vector<std::uint8_t> noise(48 * 48 * 48);
  for (auto& value : noise) value = random() % 50 == 0 ? 200 : 0;
  const auto volume = tissue_test::byte_volume(48, [&](double x, double y, double z) {
    const double d = std::sqrt(std::pow(x - 24, 2) + std::pow(y - 24, 2) + std::pow(z - 24, 2));
    if (d < 12.0) return 200.0;
    if (d < 15.0) return 0.0;
    return static_cast<double>(noise[static_cast<std::size_t>(x + 48 * (y + 48 * z))]);
  });
  const LatticeMesh lattice = stuffed({"noise", volume, 100.0}, 0.0007);
  expect_sound(lattice);
  EXPECT_GT(lattice.components_dropped, 200u);
  const double ball = 4.0 / 3.0 * M_PI * 12.0 * 12.0 * 12.0 * 1e-9;
  EXPECT_NEAR(tissue_test::inspect(as_mesh(lattice)).tet_volume, ball, 0.05 * ball);
}

TEST(Stuff, RefusesASpacingThatIsNone) {
  const Shape ball = tissue_test::synthetic_shapes()[0];
  for (const double spacing : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_EQ(refusal([&] { stuffed(ball, spacing); }).substr(0, 7), "E_PARAM") << spacing;
  }
  EXPECT_EQ(refusal([&] { stuffed(ball, 1e-6); }).substr(0, 15), "E_TOO_MANY_TETS");
}

}  // namespace
