// Soft pads and beds: holders that do not care which vertices lie where.
#include "support/bodies.h"
#include "support/mesh_checks.h"
#include "tissue/simulate/scene_file.h"

namespace {

using namespace tissue;
using tissue_test::refusal;

// A block of 60 x 60 x 30 mm on a soft bed, under a pad on top.
std::shared_ptr<const Body> block(int cells) {
  return std::make_shared<Body>(
      tissue_test::kuhn_block({2 * cells, 2 * cells, cells}, {0.06, 0.06, 0.03}));
}

SceneDescription scene_of(const std::string& model, int order, const std::string& effects = "[]") {
  return parse_scene("model: " + model + "\nelement_order: " + std::to_string(order) +
                     "\nmaterial: {young: [[0, 5e3]], poisson: 0.4}\n"
                     "anchors: [{plane: {axis: z, below: 0.001, stiffness: 1e6}}]\n"
                     "tools: [{name: tool, shape: {pad: {radius: 0.012}}, mode: grasp}]\n"
                     "solver: {tolerance: 1e-10}\neffects: " +
                     effects + "\n");
}

const Vec3 kTop(0.031, 0.029, 0.03);
const Vec3 kPush(0.0005, 0.0, -0.003);

TEST(SoftHolds, TheForceOnAToolIsTheEnergysDerivativeAndWhatTheBedBears) {
  for (const char* model : {"linear", "corotational", "neo_hookean", "mass_spring"}) {
    for (const int order : {1, 2}) {
      if (order == 2 && std::string(model) == "mass_spring") continue;
      Scene scene(scene_of(model, order), block(3));
      scene.step(ToolPose{kTop, true}, 0.0);
      const auto energy_at = [&](const Vec3& push) {
        const StepReport report = scene.step(ToolPose{kTop + push, true}, 0.01);
        EXPECT_FALSE(report.not_converged) << model << order;
        return *report.energy;
      };
      const Vec3 aside(0.0, 0.0, 1e-5);
      const double slope = (energy_at(kPush + aside) - energy_at(kPush - aside)) / 2e-5;
      energy_at(kPush);
      const Vec3 force = *scene.tool_forces()[0];
      EXPECT_NEAR(force.z(), -slope, 1e-4 * std::abs(slope)) << model << order;
      EXPECT_LE((force + scene.anchor_forces()[0]).norm(), 1e-6 * force.norm()) << model << order;
      EXPECT_GT(force.z(), 0.0);
    }
  }
}

TEST(SoftHolds, WhatTheyDoToABodyHardlyDependsOnItsMesh) {
  const auto force_on = [](int cells, ToolShape shape) {
    SceneDescription description = scene_of("linear", 2);
    description.tools[0].shape = shape;
    Scene scene(description, block(cells));
    scene.step(ToolPose{kTop, true}, 0.0);
    scene.step(ToolPose{kTop + kPush, true}, 0.01);
    return scene.tool_forces()[0]->norm();
  };
  const double pad = force_on(6, ToolShape::kPad), sphere = force_on(6, ToolShape::kSphere);
  // What is left is what the block's own elements cannot do.
  EXPECT_NEAR(force_on(3, ToolShape::kPad), pad, 0.08 * pad);
  EXPECT_NEAR(force_on(8, ToolShape::kPad), pad, 0.015 * pad);
  // A sphere holds what vertices happen to lie in it.
  EXPECT_GT(std::abs(force_on(3, ToolShape::kSphere) - sphere), 0.2 * sphere);
}

TEST(SoftHolds, AReleasedPadLetsTheTissueComeBackAndTakesHoldAgain) {
  for (const std::string effects : {"[]", "[inertia, damping]"}) {
    Scene scene(scene_of("corotational", 1, effects), block(3));
    scene.step(ToolPose{kTop, true}, 0.0);
    for (int i = 1; i <= 5; ++i) scene.step(ToolPose{kTop + 0.2 * i * kPush, true}, 0.02);
    EXPECT_GT(scene.tool_forces()[0]->norm(), 1e-3);
    for (int i = 0; i < 100; ++i) scene.step(ToolPose{kTop, false}, 0.02);
    EXPECT_EQ(scene.tool_forces()[0]->norm(), 0.0);
    double farthest = 0.0;
    for (std::size_t v = 0; v < scene.body().rest.size(); ++v) {
      farthest = std::max(
          farthest, (scene.state().positions[v] - scene.body().rest[v].cast<double>()).norm());
    }
    EXPECT_LT(farthest, 1e-5) << effects;
    scene.step(ToolPose{kTop, true}, 0.02);
    scene.step(ToolPose{kTop + kPush, true}, 0.02);
    EXPECT_GT(scene.tool_forces()[0]->norm(), 1e-3);
    scene.reset();
    EXPECT_EQ(scene.tool_forces()[0]->norm(), 0.0);
  }
}

TEST(SoftHolds, ABedHoldsABodyOnlyWhereItsSurfaceRestsOnIt) {
  EXPECT_EQ(refusal([&] { Scene(scene_of("linear", 1), block(3)); }), "");
  SceneDescription inside = scene_of("linear", 1);
  // Between the planes there is an inner layer of vertices, but the rim of the block lies there
  // too.
  auto& bed = std::get<PlaneAnchor>(inside.anchors[0]);
  bed.below->value = -1.0;
  EXPECT_EQ(refusal([&] { Scene(inside, block(3)); }),
            "E_SCENE: anchors[0]: holds no vertex of the mesh");
  EXPECT_EQ(
      refusal([] {
        parse_scene("model: linear\nanchors: [{plane: {axis: z, below: 0, stiffness: -1}}]\n");
      }).substr(0, 44),
      "E_PARAM: scene: line 2, stiffness: -1 is not");
  EXPECT_NE(refusal([] {
              parse_scene("model: linear\ntools: [{name: a, shape: {pad: {size: 1}}}]\n");
            }).find("size"),
            std::string::npos);
}

}  // namespace
