#include "tissue/refine/levels.h"

#include "support/mesh_checks.h"
#include "tissue/base/topology.h"

#include <cmath>
#include <limits>
#include <random>

namespace {

using namespace tissue;
using tissue_test::refusal;

LevelOptions with_sections(int sections, int base_level = 0) {
  LevelOptions options;
  options.sections = sections;
  options.base_level = base_level;
  return options;
}

// Equations 2 to 6 word for word: a histogram, its sums, the first index that reaches each section,
// and a search through all sections for each tet.
struct LiteralLevels {
  std::vector<std::uint32_t> thresholds;
  std::vector<std::uint8_t> levels;
};

LiteralLevels literal_levels(const std::vector<double>& densities, int sections, int base_level) {
  const std::size_t n_init = densities.size();
  std::vector<std::size_t> c(256, 0), cd(256, 0);
  for (const double density : densities) ++c[static_cast<std::size_t>(std::floor(density))];
  for (std::size_t k = 0; k < 256; ++k) {
    for (std::size_t j = 0; j <= k; ++j) cd[k] += c[j];
  }
  std::vector<double> d_th(static_cast<std::size_t>(sections) + 1, 0.0);
  for (int n = 1; n < sections; ++n) {
    for (int k = 255; k >= 0; --k) {
      if (cd[k] >= n * (n_init / static_cast<std::size_t>(sections))) d_th[n] = k;
    }
  }
  d_th[sections] = std::numeric_limits<double>::infinity();
  LiteralLevels result;
  for (int n = 0; n < sections; ++n) {
    result.thresholds.push_back(static_cast<std::uint32_t>(d_th[n]));
  }
  for (const double density : densities) {
    int level = -1;
    for (int m = 0; m < sections; ++m) {
      if (d_th[m] <= density) level = base_level + sections - 1 - m;
    }
    result.levels.push_back(static_cast<std::uint8_t>(level));
  }
  return result;
}

void expect_literal(const std::vector<double>& densities, int sections, int base_level) {
  const LevelOptions options = with_sections(sections, base_level);
  const LiteralLevels expected = literal_levels(densities, sections, base_level);
  const std::vector<std::uint32_t> thresholds = density_thresholds(densities, options);
  EXPECT_EQ(thresholds, expected.thresholds);
  EXPECT_EQ(wished_levels(densities, thresholds, base_level), expected.levels);
}

TEST(Levels, EqualALiteralSecondImplementationOnRandomHistograms) {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    const double mean = std::uniform_real_distribution<>(10, 240)(random);
    std::normal_distribution<> tissue_density(mean,
                                              std::uniform_real_distribution<>(0, 60)(random));
    std::vector<double> densities(std::uniform_int_distribution<std::size_t>(1, 400)(random));
    for (double& density : densities) {
      density = std::min(255.0, std::max(1.0, tissue_density(random)));
      if (round % 2 == 0) density = std::round(density * 4.0) / 4.0;
    }
    expect_literal(densities, std::uniform_int_distribution<>(1, 6)(random), round % 3);
  }
}

TEST(Levels, M5_ConstantDensityIsAllAtTheBaseLevel) {
  const std::vector<double> densities(100, 80.5);
  for (const int sections : {1, 3, 7}) {
    expect_literal(densities, sections, 0);
    const auto thresholds = density_thresholds(densities, with_sections(sections));
    EXPECT_EQ(wished_levels(densities, thresholds, 0), std::vector<std::uint8_t>(100, 0));
  }
  EXPECT_EQ(distinct_densities(densities), 1u);
}

TEST(Levels, M6_TheDensestClassGetsTheSmallestLevelWhenValuesAreFewerThanSections) {
  std::vector<double> densities(50, 20.0);
  densities.insert(densities.end(), 50, 200.0);
  expect_literal(densities, 5, 0);
  const auto levels = wished_levels(densities, density_thresholds(densities, with_sections(5)), 0);
  EXPECT_EQ(levels.back(), 0);
  EXPECT_GT(levels.front(), 0);
}

TEST(Levels, M7_EveryTetHasOneLevelAtThresholdsAndEnds) {
  // At a threshold, just below it, at the minimum and at the maximum.
  std::vector<double> densities = {0.0, 1.0, 63.0, 63.999, 64.0, 128.0, 127.999, 254.999, 255.0};
  for (const int sections : {1, 2, 3, 4, 9}) expect_literal(densities, sections, 1);
  for (const double density : {0.0, 255.0}) {
    const auto levels = wished_levels({density}, {0, 64, 128}, 0);
    EXPECT_EQ(levels[0], density == 0.0 ? 2 : 0);
  }
  // A density that equals a threshold belongs to the section above it.
  EXPECT_EQ(wished_levels({63.999, 64.0}, {0, 64, 128}, 0), (std::vector<std::uint8_t>{2, 1}));
}

TEST(Levels, M1_RefuseNoSections) {
  EXPECT_EQ(refusal([] { density_thresholds({1.0}, with_sections(0)); }),
            "E_N: level_sections: 0 is below 1");
}

TEST(Levels, M2_MoreSectionsThanTetsLeaveEveryTetAtTheBaseLevel) {
  const std::vector<double> densities = {10.0, 20.0, 30.0};
  expect_literal(densities, 20, 2);
  const auto thresholds = density_thresholds(densities, with_sections(20));
  EXPECT_EQ(wished_levels(densities, thresholds, 2), (std::vector<std::uint8_t>{2, 2, 2}));
}

TEST(Levels, M2_PredictionSaturates) {
  EXPECT_EQ(predicted_tets({0, 1, 2}), 1u + 8u + 64u);
  EXPECT_EQ(predicted_tets({22}), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(predicted_tets(std::vector<std::uint8_t>(100, 20)),
            std::numeric_limits<std::uint64_t>::max());
}

TEST(Levels, RefuseDensitiesBeyondTheHistogram) {
  for (const double density : {-0.5, 255.5, std::nan("")}) {
    EXPECT_EQ(refusal([&] { density_thresholds({density}, {}); }).substr(0, 7), "E_PARAM");
  }
}

// A strip of tets, each sharing a face with the next.
std::vector<Tet> tet_strip(std::uint32_t count) {
  std::vector<Tet> tets;
  for (std::uint32_t i = 0; i < count; ++i) tets.push_back({i, i + 1, i + 2, i + 3});
  return tets;
}

TEST(RaiseLevels, GradesByOneAcrossEdgesAndNoFurther) {
  const std::vector<Tet> tets = tet_strip(30);
  const EdgeTopology edges = edge_topology(tets, 33);
  std::vector<std::uint8_t> levels(30, 0);
  levels[12] = 3;
  raise_levels(levels, edges.tet_edges, edges.edges.size());
  // Tets of the strip share an edge up to two places away.
  std::vector<std::uint8_t> expected(30, 0);
  for (int i = 0; i < 30; ++i) {
    expected[i] = static_cast<std::uint8_t>(std::max(0, 3 - (std::abs(i - 12) + 1) / 2));
  }
  EXPECT_EQ(levels, expected);
}

TEST(Smoothed, KeepsAConstantAndMovesAStepTowardsItsNeighbours) {
  const std::vector<Tet> tets = tet_strip(10);
  EXPECT_EQ(smoothed(std::vector<double>(10, 7.0), tets, 13, 3), std::vector<double>(10, 7.0));
  std::vector<double> step(10, 0.0);
  std::fill(step.begin() + 5, step.end(), 100.0);
  EXPECT_EQ(smoothed(step, tets, 13, 0), step);
  const std::vector<double> once = smoothed(step, tets, 13, 1);
  EXPECT_GT(once[4], 0.0);
  EXPECT_LT(once[5], 100.0);
  EXPECT_EQ(once[0], 0.0);
}

TEST(TetMeans, AreTheMeanOfFourVertices) {
  EXPECT_EQ(tet_means({{0, 1, 2, 3}}, {1.0f, 2.0f, 4.0f, 9.0f}), std::vector<double>{4.0});
}

}  // namespace
