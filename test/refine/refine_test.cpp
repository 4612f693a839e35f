#include "tissue/refine/refine.h"

#include "support/figures.h"
#include "support/mesh_checks.h"
#include "support/shapes.h"
#include "tissue/base/tet_mesh.h"
#include "tissue/refine/levels.h"

#include <cmath>
#include <random>

namespace {

using namespace tissue;

TetMesh as_mesh(const RefinedMesh& refined, std::uint32_t lattice_vertices) {
  TetMesh mesh;
  mesh.vertices = refined.vertices;
  mesh.tets = refined.tets;
  mesh.surface = refined.surface;
  mesh.parents = refined.parents;
  mesh.lattice_vertices = lattice_vertices;
  return mesh;
}

RefinableLattice ball_lattice(double spacing) {
  const tissue_test::Shape ball = tissue_test::synthetic_shapes()[0];
  StuffingOptions options;
  options.spacing = spacing;
  return refinable(stuff(surface_at_iso(ball.volume, ball.iso), options));
}

void expect_sound(const RefinableLattice& lattice, const RefinedMesh& refined) {
  const auto lattice_vertices = static_cast<std::uint32_t>(lattice.mesh.vertices.size());
  const TetMesh mesh = as_mesh(refined, lattice_vertices);
  tissue_test::expect_sound(mesh);
  for (std::size_t i = 0; i < mesh.parents.size(); ++i) {
    const auto [a, b] = mesh.parents[i];
    const Vec3f middle = 0.5f * (mesh.vertices[a] + mesh.vertices[b]);
    ASSERT_LT((mesh.vertices[lattice_vertices + i] - middle).norm(), 1e-8f) << i;
  }
}

TEST(Refine, AllAtOneLevelIsEightToTheLevelOfEach) {
  const RefinableLattice lattice = ball_lattice(0.012);
  double volume = 0.0;
  for (std::uint8_t level = 0; level < 4; ++level) {
    SCOPED_TRACE(+level);
    const std::vector<std::uint8_t> levels(lattice.mesh.tets.size(), level);
    const RefinedMesh refined = refine(lattice, levels, 1u << 30, {1});
    EXPECT_EQ(refined.tets.size(), lattice.mesh.tets.size() << (3 * level));
    expect_sound(lattice, refined);
    // Splitting does not change what is filled.
    const double now = tissue_test::inspect(as_mesh(refined, 0)).tet_volume;
    if (level > 0) {
      EXPECT_NEAR(now, volume, 1e-6 * volume);
    }
    volume = now;
  }
}

TEST(Refine, T15_KeepsAnglesFromTheFirstLevelOn) {
  const RefinableLattice lattice = ball_lattice(0.012);
  const auto range = [&](std::uint8_t level) {
    return refine(lattice, std::vector<std::uint8_t>(lattice.mesh.tets.size(), level), 1u << 30,
                  {1})
        .dihedral;
  };
  const DihedralRange first = range(1);
  for (std::uint8_t level = 2; level < 5; ++level) {
    EXPECT_NEAR(range(level).min_angle(), first.min_angle(), 1e-9);
    tissue_test::figure("change of the smallest angle [deg]",
                        std::abs(range(level).min_angle() - first.min_angle()));
    EXPECT_NEAR(range(level).max_angle(), first.max_angle(), 1e-9);
  }
}

TEST(Refine, ClosesEveryPatternOfRandomLevels) {
  std::mt19937 random(3);
  for (int round = 0; round < 6; ++round) {
    SCOPED_TRACE(round);
    const RefinableLattice lattice = ball_lattice(round % 2 == 0 ? 0.012 : 0.0097);
    std::vector<std::uint8_t> levels(lattice.mesh.tets.size());
    // Mostly level 0, so that jumps of up to three levels have to be graded.
    for (auto& level : levels) {
      level = random() % 40 == 0 ? static_cast<std::uint8_t>(random() % 4) : std::uint8_t{0};
    }
    const RefinedMesh refined = refine(lattice, levels, 1u << 30, {1});
    expect_sound(lattice, refined);
    for (std::size_t t = 0; t < levels.size(); ++t) {
      EXPECT_GE(refined.lattice_levels[t], levels[t]);
    }
    const tissue_test::MeshFindings found = tissue_test::inspect(as_mesh(refined, 0));
    EXPECT_GE(found.min_dihedral_deg, 8.0);
    EXPECT_LE(found.max_dihedral_deg, 168.0);
  }
}

TEST(Refine, KeepsTetsOfTheLatticesOwnShapeWithin18And162Degrees) {
  RefinableLattice lattice = ball_lattice(0.005);
  std::vector<std::uint8_t> levels(lattice.mesh.tets.size());
  std::mt19937 random(5);
  for (auto& level : levels) level = static_cast<std::uint8_t>(random() % 3);
  const RefinedMesh refined = refine(lattice, levels, 1u << 30, {1});
  // Tets that lie within a whole lattice tet are known by their vertices' distance to the surface.
  TetMesh inner = as_mesh(refined, 0);
  inner.tets.clear();
  for (const Tet& tet : refined.tets) {
    bool deep = true;
    for (const std::uint32_t v : tet) {
      deep = deep && (refined.vertices[v] - Vec3f::Constant(31.5e-3f)).norm() < 15e-3f;
    }
    if (deep) inner.tets.push_back(tet);
  }
  ASSERT_GT(inner.tets.size(), 1000u);
  const tissue_test::MeshFindings found = tissue_test::inspect(inner);
  EXPECT_GE(found.min_dihedral_deg, 18.0);
  EXPECT_LE(found.max_dihedral_deg, 162.0);
}

TEST(Refine, GivesTheSameBitsWithAnyNumberOfThreads) {
  const RefinableLattice lattice = ball_lattice(0.004);
  std::vector<std::uint8_t> levels(lattice.mesh.tets.size());
  for (std::size_t t = 0; t < levels.size(); ++t)
    levels[t] = static_cast<std::uint8_t>(t / 700 % 3);
  const TetMesh one = as_mesh(refine(lattice, levels, 1u << 30, {1}), 0);
  const TetMesh many = as_mesh(refine(lattice, levels, 1u << 30, {4}), 0);
  EXPECT_EQ(mesh_uuid(one), mesh_uuid(many));
  EXPECT_EQ(one.parents, many.parents);
  EXPECT_EQ(one.surface, many.surface);
}

TEST(Refine, RefusesMoreTetsThanItMayMake) {
  const RefinableLattice lattice = ball_lattice(0.012);
  const std::vector<std::uint8_t> levels(lattice.mesh.tets.size(), 2);
  EXPECT_EQ(tissue_test::refusal([&] { refine(lattice, levels, 1000, {1}); }).substr(0, 15),
            "E_TOO_MANY_TETS");
}

}  // namespace
