// Tools that press where it is hard to.
#include "support/mesh_checks.h"
#include "support/pressing_scenes.h"
#include "tissue/base/error.h"

namespace {

using namespace tissue;
using namespace tissue_test;

TEST(Contact, P8_WhereNothingTouchesRestIsKeptToTheLastBit) {
  for (const Case& which : all_cases()) {
    Scene scene(parse_scene(scene_text(which, kFinger)), organ());
    for (int i = 0; i < 4; ++i) scene.step(above(0.001 + 0.001 * i), 0.02);
    EXPECT_EQ(farthest_from_rest(scene), 0.0) << which.name();
  }
}

TEST(Contact, AToolThatJumpsIsCaughtByItsPath) {
  for (const Case& which :
       {Case{"mass_spring"}, Case{"linear"}, Case{"corotational"}, Case{"neo_hookean"}}) {
    const std::string text = scene_text(which, kFinger, "solver: {tolerance: 1e-6}\n");
    const auto body = slab(9);
    const auto at = [](double height) {
      return ToolPose{Vec3(0.0302, 0.0313, 0.020 + kRadius + height)};
    };
    Scene jumping(parse_scene(text), body), going(parse_scene(text), body);
    // The tool's centre ends up below where the surface was.
    jumping.step(at(0.050), 0.01);
    const StepReport report = jumping.step(at(-0.008), 0.01);
    EXPECT_FALSE(report.not_converged || report.clamped) << which.name();
    for (double height = 0.002; height > -0.0081; height -= 0.002) going.step(at(height), 0.01);
    EXPECT_NEAR(jumping.tool_forces()[0]->z(), going.tool_forces()[0]->z(),
                0.05 * going.tool_forces()[0]->z())
        << which.name();
    // Springs do not keep what they span from turning inside out.
    if (which.model == "mass_spring") continue;
    for (const Vec3& place : jumping.state().positions) {
      EXPECT_GE((place - at(-0.008).position).norm(), 0.99 * kRadius) << which.name();
    }
  }
}

TEST(Contact, P4_P7_WhatCannotBeFollowedIsClampedAndAToolThatCameOutIsFree) {
  for (const Case& which : {Case{"mass_spring"}, Case{"linear"}, Case{"corotational"},
                            Case{"neo_hookean"}, Case{"corotational", 1, ", inertia, damping"}}) {
    Scene scene(parse_scene(scene_text(which, kFinger, "solver: {max_iterations: 30}\n")), organ());
    scene.step(above(0.005), 0.01);
    const auto expect_valid = [&] {
      for (const Vec3& place : scene.state().positions) {
        ASSERT_TRUE(place.allFinite()) << which.name();
        ASSERT_LE(place.norm(), 0.1) << which.name();
      }
    };
    // A metre at once, through all of the organ.
    EXPECT_TRUE(scene.step(above(-1.0), 0.01).clamped) << which.name();
    expect_valid();
    EXPECT_GT(scene.tool_forces()[0]->z(), 0.0) << which.name();
    // There it touches nothing.
    const StepReport free = scene.step(above(-1.0), 0.01);
    EXPECT_TRUE(free.not_converged || scene.tool_forces()[0]->norm() == 0.0) << which.name();
    EXPECT_TRUE(!free.not_converged || which.model == "mass_spring") << which.name();
    // Springs may come to rest in more than one way.
    if (which.effects.empty() && which.model != "mass_spring") {
      EXPECT_LE(farthest_from_rest(scene), 1e-4) << which.name();
    }
    // All the way, by hand.
    scene.reset();
    bool pushed_down = true;
    for (double height = 0.004; height > -0.09; height -= 0.006) {
      scene.step(above(height), 0.01);
      pushed_down = pushed_down && scene.tool_forces()[0]->z() > -1e-9;
      expect_valid();
    }
    EXPECT_TRUE(pushed_down) << which.name();
    const StepReport out = scene.step(above(-0.1), 0.01);
    EXPECT_TRUE(out.not_converged || scene.tool_forces()[0]->norm() == 0.0) << which.name();
    EXPECT_TRUE(!out.not_converged || which.model == "mass_spring") << which.name();
  }
}

TEST(Contact, AToolThatComesUpInTheTissueTouchesNothingUntilItHasBeenOutside) {
  Scene scene(parse_scene(scene_text({"corotational"}, kFinger)), organ());
  const StepReport inside = scene.step(above(-0.015), 0.01);
  EXPECT_TRUE(inside.tool_inside);
  EXPECT_EQ(farthest_from_rest(scene), 0.0);
  EXPECT_FALSE(scene.step(std::nullopt, 0.01).tool_inside);
  EXPECT_FALSE(scene.step(above(0.001), 0.01).tool_inside);
  scene.step(above(-0.003), 0.01);
  EXPECT_GT(scene.tool_forces()[0]->z(), 0.0);
  // One whose axis is outside makes its room.
  Scene overlapping(parse_scene(scene_text({"corotational"}, kFinger)), organ());
  const StepReport report = overlapping.step(above(-0.003), 0.01);
  EXPECT_FALSE(report.tool_inside || report.not_converged);
  EXPECT_LE(report.penetration, 0.01 * kRadius);
  EXPECT_NEAR(overlapping.tool_forces()[0]->z(), scene.tool_forces()[0]->z(),
              0.02 * scene.tool_forces()[0]->z());
}

TEST(Contact, ToolsAHundredTimesLargerAndSmallerThanATet) {
  // Edges of 5 mm.
  const auto body = slab();
  for (const double radius : {0.5, 5e-5}) {
    for (const char* model : {"linear", "corotational", "neo_hookean"}) {
      const std::string tool = "[{name: a, shape: {sphere: " + to_text(radius) + "}, mode: press}]";
      Scene scene(parse_scene(scene_text({model}, tool)), body);
      const Vec3 middle(0.0312, 0.0297, 0.020 + radius);
      scene.step(ToolPose{middle + Vec3(0.0, 0.0, 0.001)}, 0.01);
      // A small one goes far for its size.
      const double depth = radius > 0.1 ? 0.003 : 3e-4;
      const StepReport report = scene.step(ToolPose{middle - Vec3(0.0, 0.0, depth)}, 0.01);
      EXPECT_FALSE(report.not_converged || report.clamped) << model << radius;
      EXPECT_LE(report.penetration, 0.01 * radius);
      EXPECT_GT(scene.tool_forces()[0]->z(), 1e-4) << model << radius;
      EXPECT_EQ(deformation_quality(*body, scene.state()).inverted, 0u) << model << radius;
    }
  }
}

TEST(Contact, TwoToolsPressFromBothSidesUntilTheTissueIsThin) {
  for (const char* model : {"corotational", "neo_hookean"}) {
    // Held at its rim, free above and below.
    const auto body = slab();
    SceneDescription description =
        parse_scene(scene_text({model},
                               "[{name: a, shape: {sphere: 0.006}, mode: press},"
                               " {name: b, shape: {sphere: 0.006}, mode: press}]"));
    PlaneAnchor low, high;
    low.axis = high.axis = 0;
    low.below = Coordinate{0.001, false};
    high.above = Coordinate{0.059, false};
    description.anchors = {low, high};
    Scene scene(description, body);
    const auto at = [](double gap) {
      const Vec3 middle(0.0302, 0.0298, 0.010);
      const Vec3 up(0.0, 0.0, 0.5 * gap + kRadius);
      return ToolPoses{ToolPose{middle + up}, ToolPose{middle - up}};
    };
    for (double gap = 0.022; gap > 0.0059; gap -= 0.002) {
      const StepReport report = scene.step(at(gap), 0.01);
      EXPECT_FALSE(report.not_converged || report.clamped) << model << " " << gap;
      EXPECT_LE(report.penetration, 0.01 * kRadius) << model << " " << gap;
    }
    const auto forces = scene.tool_forces();
    EXPECT_GT(forces[0]->z(), 0.1);
    EXPECT_NEAR(forces[0]->z(), -forces[1]->z(), 0.05 * forces[0]->z());
    scene.step(at(0.1), 0.01);
    EXPECT_LE(farthest_from_rest(scene), 1e-4) << model;
  }
}

// The tool slides off and stops: from then on nothing drives the tissue.
TEST(Contact, EnergyNeverGrowsWhereTissueSlidesAlongAToolThatIsStill) {
  for (const char* model : {"mass_spring", "linear", "corotational", "neo_hookean"}) {
    for (const char* damping : {"", ", damping"}) {
      // Either with one of the cheap ones is enough.
      if (std::string(model) != "corotational" && (*damping != 0) != (model[0] == 'n')) continue;
      Scene scene(
          parse_scene(scene_text({model, 1, std::string(", {inertia: {iterations: 50}}") + damping},
                                 kFinger, "solver: {tolerance: 1e-9}\n")),
          slab());
      const auto at = [](double x) { return ToolPose{Vec3(x, 0.0313, 0.020 + kRadius - 0.003)}; };
      for (int i = 0; i < 5; ++i) scene.step(at(0.020 + 0.002 * i), 0.005);
      double energy = *scene.step(at(0.028), 0.005).energy;
      const double first = energy;
      for (int i = 0; i < 15; ++i) {
        const StepReport report = scene.step(at(0.028), 0.005);
        ASSERT_FALSE(report.not_converged) << model;
        ASSERT_LE(*report.energy, energy * (1.0 + 1e-6)) << model << damping << i;
        energy = *report.energy;
      }
      EXPECT_LT(energy, first);
      EXPECT_GT(energy, 0.0);
    }
  }
}

}  // namespace
