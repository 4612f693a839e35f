#include "tissue/simulate/push_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace tissue;

const std::vector<Vec3> kRest = {{0, 0, 0},      {0.01, 0, 0}, {0, 0.015, 0},
                                 {0, 0, 0.0299}, {0, 0, 0.03}, {0.02, 0.02, 0.02}};
const std::vector<double> kDensities = {50.0, 100.0, 25.0, 255.0, 10.0, 10.0};

PushOptions literal() { return {0.03, true, 0.0, true}; }

std::vector<Vec3> pushed(const PushOptions& options, const Vec3& displacement, double gain = 1.0) {
  std::vector<Vec3> positions = kRest;
  const PushField<double> field = push_field<double>(kRest, kDensities, 0, options);
  displace<double>(kRest, field, gain * displacement, positions);
  return positions;
}

TEST(PushField, LiteralFollowsFigure4ByHand) {
  // Target 0 moves by h_t = 2 mm along x; t = 3 s, R = 30 mm. Line 7 of the figure:
  // h = (R − d)/R · h_t · t·t/(2ρ), for each vertex by hand.
  const std::vector<Vec3> moved = pushed(literal(), Vec3(0.002, 0, 0), 9.0);
  const double by_hand[6] = {
      1.0 * 0.002 * 9.0 / 100.0,              // d = 0,      ρ = 50
      (2.0 / 3.0) * 0.002 * 9.0 / 200.0,      // d = 10 mm,  ρ = 100
      0.5 * 0.002 * 9.0 / 50.0,               // d = 15 mm,  ρ = 25
      (0.0001 / 0.03) * 0.002 * 9.0 / 510.0,  // d = 29.9 mm, ρ = 255
      0.0,                                    // d = 30 mm: not below R
      0.0,                                    // d = 34.6 mm
  };
  for (int v = 0; v < 6; ++v) {
    EXPECT_NEAR(moved[v].x() - kRest[v].x(), by_hand[v], 1e-12) << v;
    EXPECT_EQ(moved[v].y(), kRest[v].y());
    EXPECT_EQ(moved[v].z(), kRest[v].z());
  }
}

TEST(PushField, DefaultMeetsTheToolAndMovesHardTissueLess) {
  const PushOptions options{0.03, true, 50.0, false};
  const std::vector<Vec3> moved = pushed(options, Vec3(0, 0, -0.004));
  EXPECT_EQ(moved[0], Vec3(0, 0, -0.004));
  EXPECT_NEAR(moved[1].z(), -0.004 * (2.0 / 3.0) * 0.5, 1e-15);  // ρ = 100 against ρ_ref = 50
  EXPECT_NEAR(moved[2].z(), -0.004 * 0.5, 1e-15);  // softer than ρ_ref: no more than 1
}

TEST(PushField, TheReferenceIsTheMedianWithinReach) {
  EXPECT_EQ(median_density<double>({0, 1, 2, 3}, kDensities), 100.0);
  EXPECT_EQ(median_density<double>({}, kDensities), 1.0);
  // A target harder than the reference still meets the tool.
  const PushField<double> field =
      push_field<double>(kRest, {200.0, 10.0, 10.0, 10.0, 1.0, 1.0}, 0, {0.03, true, 0.0, false});
  EXPECT_EQ(field.weights[0], 1.0);
}

TEST(PushField, WithoutDensityResponseOnlyDistanceCounts) {
  const std::vector<Vec3> moved = pushed({0.03, false, 0.0, false}, Vec3(0.003, 0, 0));
  EXPECT_NEAR(moved[1].x() - 0.01, 0.002, 1e-15);
}

TEST(PushField, T2_StaysFiniteAndBoundedForDensitiesAndReachesThatMakeNoSense) {
  for (const double density : {0.0, 1e-300, -5.0, 255.0}) {
    for (const double range : {0.03, 1e-9, 1e9}) {
      const std::vector<double> densities(kRest.size(), density);
      const PushField<double> field =
          push_field<double>(kRest, densities, 0, {range, true, 0.0, false});
      for (const double weight : field.weights) {
        EXPECT_TRUE(std::isfinite(weight));
        EXPECT_GE(weight, 0.0);
        EXPECT_LE(weight, 1.0);
      }
    }
  }
  // R = 0 moves nothing.
  EXPECT_TRUE(push_field<double>(kRest, kDensities, 0, {0.0, true, 0.0, false}).vertices.empty());
}

TEST(PushField, T2_P8_AZeroPushIsTheRestShapeToTheLastBit) {
  EXPECT_EQ(pushed({0.03, true, 0.0, false}, Vec3::Zero()), kRest);
  EXPECT_EQ(pushed(literal(), Vec3::Zero(), 100.0), kRest);
}

TEST(PushField, TheFloatKernelAgreesWithTheDoubleOne) {
  std::mt19937 random(11);
  std::uniform_real_distribution<> place(-0.05, 0.05), density(1.0, 255.0);
  std::vector<Vec3> rest;
  std::vector<Vec3f> rest_float;
  std::vector<double> densities;
  std::vector<float> densities_float;
  for (int i = 0; i < 2000; ++i) {
    rest_float.push_back(Vec3(place(random), place(random), place(random)).cast<float>());
    rest.push_back(rest_float.back().cast<double>());
    densities_float.push_back(static_cast<float>(density(random)));
    densities.push_back(static_cast<double>(densities_float.back()));
  }
  const PushOptions options{0.04, true, 90.0, false};
  std::vector<Vec3> exact = rest, shipped = rest;
  const Vec3 displacement(0.011, -0.007, 0.013);
  displace<double>(rest, push_field<double>(rest, densities, 3, options), displacement, exact);
  displace<float>(rest_float, push_field<float>(rest_float, densities_float, 3, options),
                  displacement.cast<float>(), shipped);
  for (std::size_t v = 0; v < rest.size(); ++v) {
    EXPECT_LT((exact[v] - shipped[v]).norm(), 1e-6 * displacement.norm()) << v;
  }
}

}  // namespace
