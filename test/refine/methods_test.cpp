// What a mesh can be asked for beside densities: other methods, totals, components, to stop.
#include "support/mesh_checks.h"
#include "support/sanitizers.h"
#include "support/shapes.h"
#include "tissue/base/machine_memory.h"
#include "tissue/refine/build_mesh.h"

#include <sys/resource.h>

#include <cmath>
#include <random>

namespace {

using namespace tissue;
using tissue_test::expect_conforming;
using tissue_test::refusal;

MeshOptions options_for(Method method, double spacing) {
  MeshOptions options;
  options.method = method;
  options.spacing = spacing;
  return options;
}

TEST(Methods, AllAreConformingAndSayWhatTheyAre) {
  const auto organ = tissue_test::organ_phantom({64, 80, 56});
  const TetMesh uniform = build_mesh(organ, nullptr, options_for(Method::kUniform, 0.005)).mesh;
  expect_conforming(uniform);
  EXPECT_EQ(uniform.statistics.initial, uniform.tets.size());
  EXPECT_EQ(uniform.statistics.closure, 0);

  const TetMesh surface = build_mesh(organ, nullptr, options_for(Method::kSurface, 0.008)).mesh;
  expect_conforming(surface);
  std::vector<std::uint8_t> on_boundary(surface.vertices.size(), 0);
  for (const Triangle& triangle : surface.surface) {
    for (const std::uint32_t v : triangle) on_boundary[v] = 1;
  }
  // Fine wherever a tet touches the boundary, and coarse somewhere inside.
  std::uint8_t coarsest = 9;
  for (std::size_t t = 0; t < surface.tets.size(); ++t) {
    bool touches = false;
    for (const std::uint32_t v : surface.tets[t]) touches = touches || on_boundary[v] != 0;
    if (touches) {
      ASSERT_EQ(surface.levels[t], 2);
    }
    coarsest = std::min(coarsest, surface.levels[t]);
  }
  EXPECT_EQ(coarsest, 0);
  // Blind to density.
  Volume other = *organ;
  for (auto& value : std::get<std::vector<std::uint8_t>>(other.voxels)) {
    if (value > 20) value = static_cast<std::uint8_t>(21 + (value * 7) % 230);
  }
  const TetMesh again = build_mesh(std::make_shared<Volume>(other), surface_at_iso(organ, 20.0),
                                   options_for(Method::kSurface, 0.008))
                            .mesh;
  EXPECT_EQ(again.tets, surface.tets);
}

TEST(Methods, KeptInterfacesMakeTheBorderOfATumourAsFineAsTheTissue) {
  // A ball of 255 in even tissue of two densities, so that levels are known.
  const auto organ = tissue_test::byte_volume(64, [](double x, double y, double z) {
    const double r = std::sqrt(std::pow(x - 31, 2) + std::pow(y - 31, 2) + std::pow(z - 31, 2));
    return r > 28 ? 0.0 : r < 9 ? 255.0 : x < 31 ? 60.0 : 100.0;
  });
  MeshOptions options = options_for(Method::kDensity, 0.006);
  options.levels.smooth_levels = 0;
  const auto straddling_level = [&](const TetMesh& mesh) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      float low = 255.0f, high = 0.0f;
      for (const std::uint32_t v : mesh.tets[t]) {
        low = std::min(low, mesh.densities[v]);
        high = std::max(high, mesh.densities[v]);
      }
      if (high < 250.0f || low > 110.0f) continue;
      sum += mesh.levels[t];
      ++count;
    }
    return sum / count;
  };
  const TetMesh plain = build_mesh(organ, nullptr, options).mesh;
  options.keep_interfaces = true;
  const TetMesh kept = build_mesh(organ, nullptr, options).mesh;
  expect_conforming(kept);
  EXPECT_GT(straddling_level(kept), straddling_level(plain) + 0.2);
}

TEST(Methods, MeetATotalWithinTwoPercent) {
  const auto brain = tissue_test::shipped_brain();
  for (const Method method : {Method::kDensity, Method::kUniform, Method::kSurface}) {
    for (const std::uint64_t wished : {40000u, 250000u}) {
      MeshOptions options = options_for(method, 0.0);
      options.target_tetrahedra = wished;
      options.project_boundary = false;
      const MeshStatistics found = build_mesh(brain, nullptr, options).mesh.statistics;
      EXPECT_NEAR(static_cast<double>(found.tetrahedra) / static_cast<double>(wished), 1.0, 0.02);
    }
  }
}

TEST(Methods, KeepTheComponentThatIsAskedFor) {
  const auto balls = tissue_test::float_volume(64, [](double x, double y, double z) {
    const double large =
        14.0 - std::sqrt(std::pow(x - 18, 2) + std::pow(y - 31, 2) + std::pow(z - 31, 2));
    const double small =
        9.0 - std::sqrt(std::pow(x - 48, 2) + std::pow(y - 31, 2) + std::pow(z - 31, 2));
    return 100.0 + 5.0 * std::max(large, small);
  });
  MeshOptions options = options_for(Method::kUniform, 0.003);
  options.iso_value = 100.0;
  const auto volume_of = [&](const Component& component) {
    options.component = component;
    const TetMesh mesh = build_mesh(balls, nullptr, options).mesh;
    expect_conforming(mesh);
    return mesh.statistics.volume;
  };
  const double large = 4.0 / 3.0 * M_PI * std::pow(14e-3, 3),
               small = 4.0 / 3.0 * M_PI * std::pow(9e-3, 3);
  EXPECT_NEAR(volume_of({}), large, 0.03 * large);
  EXPECT_NEAR(volume_of({Component::Choice::kAll, Vec3::Zero()}), large + small, 0.03 * large);
  EXPECT_NEAR(volume_of({Component::Choice::kNearest, Vec3(0.06, 0.03, 0.03)}), small,
              0.05 * small);
}

TEST(Methods, LabelsStandForTheirDensities) {
  auto labels =
      std::make_shared<Volume>(*tissue_test::byte_volume(40, [](double x, double y, double z) {
        const double r = std::sqrt(std::pow(x - 19, 2) + std::pow(y - 19, 2) + std::pow(z - 19, 2));
        return r > 16 ? 0.0 : r > 7 ? 3.0 : 8.0;
      }));
  labels->quantity = Quantity::kLabel;
  MeshOptions options = options_for(Method::kDensity, 0.004);
  options.label_densities = {{3, 40.0}, {8, 255.0}};
  const TetMesh mesh = build_mesh(labels, labels, options).mesh;
  expect_conforming(mesh);
  for (std::size_t v = 0; v < mesh.lattice_vertices; ++v) {
    const float density = mesh.densities[v];
    ASSERT_TRUE(density == 1.0f || density == 40.0f || density == 255.0f) << density;
  }
  options.label_densities.erase(8);
  EXPECT_EQ(refusal([&] { build_mesh(labels, labels, options); }),
            "E_PARAM: label_densities: label 8 of the volume is not in the table");
  options.label_densities = {{3, -1.0}};
  EXPECT_EQ(refusal([&] { build_mesh(labels, labels, options); }).substr(0, 29),
            "E_PARAM: label_densities: -1 ");
}

TEST(Methods, M9_ABuildThatIsCancelledStopsAtItsNextPieceAndSaysHowFarItCame) {
  const auto organ = tissue_test::organ_phantom({64, 80, 56});
  std::vector<std::string> stages;
  for (const std::string last : {"lattice", "levels", "refinement", "projection", "densities"}) {
    stages.clear();
    tissue::Run run;
    run.cancelled = std::make_shared<std::atomic<bool>>(false);
    double fraction = 0.0;
    run.report = [&](const Progress& progress) {
      stages.push_back(progress.stage);
      EXPECT_GE(progress.fraction, fraction);
      fraction = progress.fraction;
      if (progress.stage == last) *run.cancelled = true;
    };
    EXPECT_EQ(
        refusal([&] { build_mesh(organ, nullptr, options_for(Method::kDensity, 0.006), run); }),
        "E_CANCELLED: cancelled on request");
    EXPECT_EQ(stages.back(), last);
  }
  EXPECT_EQ(stages.front(), "lattice");
}

TEST(Methods, WhatWouldNotFitIntoMemoryIsRefusedWithTheFigureBeforeItStarts) {
  if (tissue_test::kSanitized) GTEST_SKIP() << "a sanitizer needs the address space";
  const auto organ = tissue_test::organ_phantom({64, 80, 56});
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  rlimit tight = before;
  const auto now = [] { return available_memory(); };
  // Leave this process 40 MB: a million tets need 44.
  std::size_t pages = 0;
  FILE* statm = fopen("/proc/self/statm", "r");
  ASSERT_EQ(fscanf(statm, "%zu", &pages), 1);
  fclose(statm);
  tight.rlim_cur = pages * 4096 + 40000000;
  ASSERT_EQ(setrlimit(RLIMIT_AS, &tight), 0);
  EXPECT_LE(now(), 40000000u);
  MeshOptions options = options_for(Method::kUniform, 0.0);
  options.target_tetrahedra = 1000000;
  const std::string text = refusal([&] { build_mesh(organ, nullptr, options); });
  setrlimit(RLIMIT_AS, &before);
  EXPECT_EQ(text.substr(0, 80),
            "E_NOMEM: target_tetrahedra would make about 1e+06 tets, which need about 44 MB; ")
      << text;
}

TEST(Methods, V13_NoiseOfAHundredThousandComponentsKeepsOneAndCountsTheRest) {
  // Loose cubes of 2³ voxels around a ball.
  const auto noise = tissue_test::byte_volume(190, [&](double x, double y, double z) {
    const double r = std::sqrt(std::pow(x - 95, 2) + std::pow(y - 95, 2) + std::pow(z - 95, 2));
    if (r < 12) return 200.0;
    const int i = static_cast<int>(x), j = static_cast<int>(y), k = static_cast<int>(z);
    return i % 4 < 2 && j % 4 < 2 && k % 4 < 2 && r > 17 ? 200.0 : 0.0;
  });
  MeshOptions options = options_for(Method::kDensity, 0.00098);
  options.iso_value = 100.0;
  const TetMesh mesh = build_mesh(noise, nullptr, options).mesh;
  expect_conforming(mesh);
  EXPECT_GT(mesh.statistics.components_dropped, 90000u);
  const double ball = 4.0 / 3.0 * M_PI * std::pow(12e-3, 3);
  EXPECT_NEAR(mesh.statistics.volume, ball, 0.1 * ball);
}

TEST(Methods, V15_AVolumeTooLargeForAMessageIsMeshedFromMemory) {
  // 1024³ voxels: a gigabyte, with a ball in it.
  constexpr std::uint32_t kSize = 1024;
  auto volume = std::make_shared<Volume>();
  volume->grid.size = {kSize, kSize, kSize};
  volume->grid.spacing = Vec3::Constant(2e-4);
  std::vector<std::uint8_t> values(volume->grid.voxel_count(), 0);
  constexpr double kRadius = 400.0;
  for (std::uint32_t z = 0; z < kSize; ++z) {
    for (std::uint32_t y = 0; y < kSize; ++y) {
      const double squared = kRadius * kRadius - std::pow(y - 512.0, 2) - std::pow(z - 512.0, 2);
      if (squared <= 0.0) continue;
      const auto half = static_cast<std::ptrdiff_t>(std::sqrt(squared));
      const auto row =
          static_cast<std::ptrdiff_t>(std::size_t{kSize} * (y + std::size_t{kSize} * z));
      std::fill_n(values.begin() + row + 512 - half, 2 * half, std::uint8_t{100});
    }
  }
  volume->voxels = std::move(values);
  const TetMesh mesh = build_mesh(volume, nullptr, options_for(Method::kDensity, 0.008)).mesh;
  expect_conforming(mesh);
  const double ball = 4.0 / 3.0 * M_PI * std::pow(kRadius * 2e-4, 3);
  EXPECT_NEAR(mesh.statistics.volume, ball, 0.01 * ball);
}

TEST(Methods, M3_TotalsThatCannotBeAreRefused) {
  const auto organ = tissue_test::organ_phantom({32, 32, 32});
  MeshOptions options = options_for(Method::kDensity, 0.004);
  options.target_tetrahedra = 1000;
  EXPECT_EQ(refusal([&] { build_mesh(organ, nullptr, options); }).substr(0, 33),
            "E_PARAM: target_tetrahedra: 1000 ");
  options.target_tetrahedra = 0;
  options.projection.sweeps = 0;
  EXPECT_EQ(refusal([&] { build_mesh(organ, nullptr, options); }).substr(0, 32),
            "E_PARAM: projection: 0 and 2 swe");
  options.projection.sweeps = 4;
  options.spacing = 0.0;
  options.target_tetrahedra = 5;
  EXPECT_EQ(refusal([&] { build_mesh(organ, nullptr, options); }).substr(0, 32),
            "E_NTINIT: target_tetrahedra: 5 i");
  options.target_tetrahedra = 1000000000000u;
  EXPECT_EQ(refusal([&] { build_mesh(organ, nullptr, options); }).substr(0, 15), "E_TOO_MANY_TETS");
}

}  // namespace
