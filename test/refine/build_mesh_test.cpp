#include "tissue/refine/build_mesh.h"

#include "support/figures.h"
#include "support/mesh_checks.h"
#include "support/shapes.h"
#include "tissue/field/edit_volume.h"
#include "tissue/field/mask.h"

#include <cmath>
#include <numeric>

namespace {

using namespace tissue;
using tissue_test::expect_conforming;
using tissue_test::refusal;
using tissue_test::Shape;

MeshOptions options_for(const Shape& shape, double spacing, int smooth_levels) {
  MeshOptions options;
  options.iso_value = shape.iso;
  options.spacing = spacing;
  options.levels.smooth_levels = smooth_levels;
  return options;
}

void expect_within_bounds(const TetMesh& mesh) {
  expect_conforming(mesh);
  EXPECT_GE(mesh.statistics.dihedral[0] * 180.0 / M_PI, 8.0);
  EXPECT_LE(mesh.statistics.dihedral[1] * 180.0 / M_PI, 168.0);
}

TEST(BuildMesh, IsConformingAndWithinItsAnglesOnEverySyntheticShape) {
  for (const Shape& shape : tissue_test::synthetic_shapes()) {
    for (const int smooth_levels : {0, 2}) {
      SCOPED_TRACE(shape.name + " smoothed " + std::to_string(smooth_levels));
      expect_within_bounds(
          build_mesh(shape.volume, nullptr, options_for(shape, 0.0061, smooth_levels)).mesh);
    }
  }
}

TEST(BuildMesh, IsConformingAndWithinItsAnglesOnRealVolumes) {
  for (const Shape& shape : tissue_test::real_volumes()) {
    SCOPED_TRACE(shape.name);
    expect_within_bounds(build_mesh(shape.volume, nullptr, options_for(shape, 0.0115, 0)).mesh);
  }
}

TEST(BuildMesh, ClosesTheShippedBrainWithinItsBounds) {
  const Shape brain = {"ch2bet", tissue_test::shipped_brain(), 20.0};
  for (const auto& [smooth_levels, bound] : {std::pair<int, double>{0, 0.20}, {2, 0.12}}) {
    const MeshStatistics found =
        build_mesh(brain.volume, nullptr, options_for(brain, 0.0065, smooth_levels))
            .mesh.statistics;
    const double wished =
        static_cast<double>(found.tetrahedra) - static_cast<double>(found.closure);
    EXPECT_LE(static_cast<double>(found.closure), bound * wished);
    EXPECT_GT(found.closure, 0);
    EXPECT_EQ(std::accumulate(found.levels.begin(), found.levels.end(), std::uint64_t{0}),
              found.initial);
  }
}

TEST(BuildMesh, LevelsCanBeComputedAgainFromTheLatticeStage) {
  const Shape brain = {"ch2bet", tissue_test::shipped_brain(), 20.0};
  MeshOptions options = options_for(brain, 0.012, 0);
  options.lattice_only = true;
  const BuiltMesh built = build_mesh(brain.volume, nullptr, options);
  const std::vector<double> means = tet_means(built.mesh.tets, built.mesh.densities);
  EXPECT_EQ(means, built.lattice_densities);
  const auto thresholds = density_thresholds(means, options.levels);
  EXPECT_EQ(thresholds, built.mesh.statistics.thresholds);
  EXPECT_EQ(wished_levels(means, thresholds, 0), built.level_wishes);
  for (std::size_t t = 0; t < means.size(); ++t) {
    ASSERT_GE(built.mesh.levels[t], built.level_wishes[t]);
  }
}

TEST(BuildMesh, LeavesATumourCoarseAndDense) {
  Volume volume = *tissue_test::shipped_brain();
  const Vec3 centre(0.0, -0.02, 0.01);
  insert_tumour(volume, {centre, 0.015, 255.0});
  MeshOptions options;
  options.spacing = 0.008;
  const TetMesh mesh =
      build_mesh(std::make_shared<Volume>(std::move(volume)), nullptr, options).mesh;
  std::size_t within = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Vec3 centroid = Vec3::Zero();
    for (const std::uint32_t v : mesh.tets[t]) centroid += 0.25 * mesh.vertices[v].cast<double>();
    if ((centroid - centre).norm() > 0.007) continue;
    ++within;
    EXPECT_EQ(mesh.levels[t], 0);
    EXPECT_EQ(mesh.tet_densities[t], 255.0f);
  }
  EXPECT_GT(within, 5u);
}

TEST(BuildMesh, MeetsTheWishedNumberOfInitialTetsWithinTwoPercent) {
  const Shape brain = {"ch2bet", tissue_test::shipped_brain(), 20.0};
  for (const std::uint32_t wished : {3000u, 20000u}) {
    MeshOptions options = options_for(brain, 0.0, 2);
    options.initial_tetrahedra = wished;
    options.levels.sections = 1;
    const MeshStatistics found = build_mesh(brain.volume, nullptr, options).mesh.statistics;
    EXPECT_NEAR(static_cast<double>(found.initial), wished, 0.02 * wished);
    EXPECT_EQ(found.tetrahedra, found.initial);
  }
}

TEST(BuildMesh, M10_TheSameRequestGivesTheSameMeshWithAnyNumberOfThreads) {
  const Shape blob = tissue_test::synthetic_shapes()[4];
  const MeshOptions options = options_for(blob, 0.005, 1);
  tissue::Run run;
  run.threads = 1;
  const std::string once = build_mesh(blob.volume, nullptr, options, run).mesh.uuid;
  EXPECT_EQ(build_mesh(blob.volume, nullptr, options, run).mesh.uuid, once);
  run.threads = 3;
  EXPECT_EQ(build_mesh(blob.volume, nullptr, options, run).mesh.uuid, once);
}

TEST(BuildMesh, V18_DoesNotDependOnTheEncoding) {
  const auto f = [](double x, double y, double z) {
    return 250.0 - 6.0 * std::sqrt((x - 20) * (x - 20) + (y - 21) * (y - 21) + (z - 19) * (z - 19));
  };
  const auto bytes = tissue_test::byte_volume(40, f);
  Volume floats = *bytes;
  const auto& values = std::get<std::vector<std::uint8_t>>(bytes->voxels);
  floats.voxels = std::vector<float>(values.begin(), values.end());
  const MeshOptions options = options_for({"", bytes, 100.0}, 0.005, 0);
  EXPECT_EQ(build_mesh(bytes, nullptr, options).mesh.uuid,
            build_mesh(std::make_shared<Volume>(floats), nullptr, options).mesh.uuid);
}

TEST(BuildMesh, V11_ARotatedGridGivesTheSameMeshRotated) {
  const Shape blob = tissue_test::synthetic_shapes()[4];
  Volume turned = *blob.volume;
  turned.grid.origin = Vec3(0.1, 0.2, 0.3);
  turned.grid.axes = Eigen::AngleAxisd(0.6, Vec3(1, -2, 2) / 3.0).toRotationMatrix();
  const MeshOptions options = options_for(blob, 0.006, 0);
  const TetMesh straight = build_mesh(blob.volume, nullptr, options).mesh;
  const TetMesh rotated = build_mesh(std::make_shared<Volume>(turned), nullptr, options).mesh;
  expect_conforming(rotated);
  ASSERT_EQ(straight.tets, rotated.tets);
  for (std::size_t v = 0; v < straight.vertices.size(); ++v) {
    const Vec3 expected = turned.grid.to_world(straight.vertices[v].cast<double>());
    ASSERT_LT((rotated.vertices[v].cast<double>() - expected).norm(), 1e-6);
  }
}

TEST(BuildMesh, TakesAMaskOnTheSameGridOnly) {
  const Shape ball = tissue_test::synthetic_shapes()[0];
  auto mask = std::make_shared<Volume>(threshold_mask(*ball.volume, ball.iso));
  MeshOptions options = options_for({"", ball.volume, 1e9}, 0.006, 0);
  const TetMesh mesh = build_mesh(ball.volume, mask, options).mesh;
  expect_within_bounds(mesh);
  const double expected = 4.0 / 3.0 * M_PI * std::pow(24.3e-3, 3);
  EXPECT_NEAR(mesh.statistics.volume, expected, 0.04 * expected);
  auto other = std::make_shared<Volume>(*mask);
  other->grid.spacing *= 2.0;
  EXPECT_EQ(refusal([&] { build_mesh(ball.volume, other, options); }).substr(0, 15),
            "E_SIZE_MISMATCH");
}

TEST(BuildMesh, V9_ThinThingsGiveAMeshOrNameASpacing) {
  const auto voxel = tissue_test::byte_volume(1, [](double, double, double) { return 200.0; });
  MeshOptions options;
  options.iso_value = 100.0;
  options.initial_tetrahedra = 200;
  expect_within_bounds(build_mesh(voxel, nullptr, options).mesh);
}

struct BadRequest {
  std::string expected;
  std::function<void(MeshOptions&)> spoil;
};

TEST(BuildMesh, M1_M2_M3_M4_RefusesBadRequestsByFieldAndValue) {
  const Shape ball = tissue_test::synthetic_shapes()[0];
  const double nan = std::nan("");
  const std::vector<BadRequest> requests = {
      {"E_N: level_sections: 0 is not within 1 to 255",
       [](MeshOptions& o) { o.levels.sections = 0; }},
      {"E_TOO_MANY_TETS: level_sections: 20 on ", [](MeshOptions& o) { o.levels.sections = 20; }},
      {"E_NTINIT: initial_tetrahedra: 0 is below 24",
       [](MeshOptions& o) {
         o.spacing = 0.0;
         o.initial_tetrahedra = 0;
       }},
      {"E_NTINIT: initial_tetrahedra: 1 is below 24",
       [](MeshOptions& o) {
         o.spacing = 0.0;
         o.initial_tetrahedra = 1;
       }},
      {"E_TOO_MANY_TETS: initial_tetrahedra: 1000000000 is over",
       [](MeshOptions& o) {
         o.spacing = 0.0;
         o.initial_tetrahedra = 1000000000;
       }},
      {"E_TOO_MANY_TETS: initial_tetrahedra: 4294967295 is over",
       [](MeshOptions& o) {
         o.spacing = 0.0;
         o.initial_tetrahedra = static_cast<std::uint32_t>(-1);
       }},
      {"E_PARAM: iso_value: nan", [nan](MeshOptions& o) { o.iso_value = nan; }},
      {"E_PARAM: spacing: -1 m", [](MeshOptions& o) { o.spacing = -1.0; }},
      {"E_PARAM: spacing: inf m", [](MeshOptions& o) { o.spacing = HUGE_VAL; }},
      {"E_TOO_MANY_TETS: spacing: 1e-05 m would make about",
       [](MeshOptions& o) { o.spacing = 1e-5; }},
      {"E_PARAM: d_max: nan", [nan](MeshOptions& o) { o.levels.d_max = nan; }},
      {"E_PARAM: base_level: -1", [](MeshOptions& o) { o.levels.base_level = -1; }},
      {"E_PARAM: window: 5 to 5",
       [](MeshOptions& o) {
         o.window = {{5.0, 5.0}};
       }},
      {"E_EMPTY_SURFACE: iso_value: 1000 leaves nothing inside",
       [](MeshOptions& o) { o.iso_value = 1000.0; }},
  };
  for (const BadRequest& request : requests) {
    MeshOptions options = options_for(ball, 0.006, 0);
    request.spoil(options);
    const std::string text = refusal([&] { build_mesh(ball.volume, nullptr, options); });
    EXPECT_EQ(text.substr(0, request.expected.size()), request.expected) << text;
  }
}

TEST(BuildMesh, M2_ManySectionsAreFineWhereTissueIsConstant) {
  const auto solid = tissue_test::byte_volume(30, [](double, double, double) { return 200.0; });
  MeshOptions options;
  options.iso_value = 100.0;
  options.spacing = 0.004;
  options.levels.sections = 255;
  const MeshStatistics found = build_mesh(solid, nullptr, options).mesh.statistics;
  EXPECT_EQ(found.tetrahedra, found.initial);
  EXPECT_EQ(found.distinct_densities, 1u);
}

TEST(BuildMesh, V10_MeshesAnAnisotropicBallAtItsTrueSize) {
  // 0.8 x 0.8 x 4 mm: a ball of 20 mm radius.
  auto volume = std::make_shared<Volume>();
  volume->grid.size = {64, 64, 14};
  volume->grid.spacing = Vec3(0.8e-3, 0.8e-3, 4e-3);
  std::vector<float> values;
  for (int z = 0; z < 14; ++z) {
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) {
        const Vec3 place(0.8e-3 * (x - 31.5), 0.8e-3 * (y - 31.5), 4e-3 * (z - 6.5));
        values.push_back(static_cast<float>(100.0 + 4000.0 * (20e-3 - place.norm())));
      }
    }
  }
  volume->voxels = values;
  const TetMesh mesh = build_mesh(volume, nullptr, options_for({"", volume, 100.0}, 0.005, 0)).mesh;
  expect_within_bounds(mesh);
  // Trilinear interpolation over 4 mm cuts a 20 mm ball short by up to h²/(8 r) = 0.1 mm in depth.
  const double ball = 4.0 / 3.0 * M_PI * 8e-6;
  EXPECT_NEAR(mesh.statistics.volume, ball, 0.05 * ball);
  tissue_test::figure("error of the volume", std::abs(mesh.statistics.volume / ball - 1.0));
}

}  // namespace
