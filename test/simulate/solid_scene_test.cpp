// Scenes in which tissue is a solid.
#include "support/bodies.h"
#include "support/mesh_checks.h"
#include "tissue/simulate/scene_file.h"

#include <fstream>
#include <sstream>
#include <thread>

namespace {

using namespace tissue;
using tissue_test::refusal;

// A block of 60 x 30 x 30 mm of which the end at x = 0 is held.
std::shared_ptr<const Body> block(int cells = 3) {
  auto body = std::make_shared<Body>(
      tissue_test::kuhn_block({2 * cells, cells, cells}, {0.06, 0.03, 0.03}));
  return body;
}

std::shared_ptr<const Body> refined() {
  static const auto body = std::make_shared<Body>(body_of(tissue_test::refined_ball(0.012)));
  return body;
}

SceneDescription scene_of(const std::string& model, const std::string& more = "",
                          const std::string& effects = "[]") {
  return parse_scene("model: " + model + "\nmaterial: {young: [[0, 5e3]], poisson: 0.4}\n" +
                     "anchors: [{plane: {axis: x, below: 10%}}]\n" +
                     "tools: [{name: tool, shape: {sphere: 0.012}, mode: grasp}]\n" +
                     "effects: " + effects + "\n" + more);
}

const char* const kSolids[] = {"linear", "corotational", "neo_hookean"};
const Vec3 kEnd(0.06, 0.015, 0.015);

TEST(SolidScene, AGraspedPatchGoesWithTheToolAndTheTissueComesBackWhenItIsReleased) {
  for (const char* model : kSolids) {
    for (const int order : {1, 2}) {
      const auto body = block();
      Scene scene(scene_of(model, "element_order: " + std::to_string(order) +
                                      "\nsolver: {tolerance: 1e-9}\n"),
                  body);
      scene.step(ToolPose{kEnd, true}, 0.0);
      const ToolPose pulled = {kEnd + Vec3(0.006, 0.0, 0.004), true,
                               Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Vec3::UnitX()))};
      const StepReport report = scene.step(pulled, 0.01);
      EXPECT_FALSE(report.not_converged) << model << order;
      EXPECT_GT(*report.energy, 0.0);
      std::size_t moved = 0;
      for (std::size_t v = 0; v < body->rest.size(); ++v)
        moved += scene.state().positions[v] != Vec3(body->rest[v].cast<double>());
      EXPECT_GT(moved, 0u);
      EXPECT_EQ(report.moved_vertices, moved) << model << order;
      std::size_t gripped = 0;
      for (std::size_t v = 0; v < body->rest.size(); ++v) {
        const Vec3 rest = body->rest[v].cast<double>(), now = scene.state().positions[v];
        if (rest.x() < 0.006) {
          EXPECT_EQ(now, rest);
        }
        if ((rest - kEnd).norm() > 0.012) continue;
        ++gripped;
        EXPECT_LE((now - (pulled.position + pulled.orientation * (rest - kEnd))).norm(), 1e-12);
      }
      EXPECT_GT(gripped, 3u);
      // The tissue pulls the tool back.
      EXPECT_LT(scene.tool_forces()[0]->x(), 0.0);
      EXPECT_EQ(deformation_quality(*body, scene.state()).inverted, 0u);
      scene.step(ToolPose{pulled.position, false}, 0.01);
      for (std::size_t v = 0; v < body->rest.size(); ++v) {
        EXPECT_LE((scene.state().positions[v] - body->rest[v].cast<double>()).norm(), 1e-6 * 0.06)
            << model << order;
      }
    }
  }
}

// Small strain is superposed from columns: the answer to twice the motion is twice the answer, and
// near rest the solid that is solved answers the same.
TEST(SolidScene, TheLinearModelSuperposesWhatTheOthersSolve) {
  for (const int order : {1, 2}) {
    const auto body = block();
    const std::string more =
        "element_order: " + std::to_string(order) + "\nsolver: {tolerance: 1e-9}\n";
    const auto displaced = [&](const char* model, double size) {
      Scene scene(scene_of(model, more), body);
      scene.step(ToolPose{kEnd, true}, 0.0);
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(size, Vec3(1, 2, 3).normalized()));
      scene.step(ToolPose{kEnd + size * Vec3(0.02, 0.01, -0.03), true, turn}, 0.01);
      std::vector<Vec3> result = scene.state().positions;
      for (std::size_t v = 0; v < result.size(); ++v) result[v] -= body->rest[v].cast<double>();
      result.push_back(1e-3 * *scene.tool_forces()[0]);
      return result;
    };
    const auto once = displaced("linear", 1e-4), twice = displaced("linear", 2e-4),
               solved = displaced("neo_hookean", 1e-4);
    for (std::size_t v = 0; v < once.size(); ++v) {
      EXPECT_LE((twice[v] - 2.0 * once[v]).norm(), 1e-3 * once.front().norm() + 1e-9);
      EXPECT_LE((solved[v] - once[v]).norm(), 1e-2 * once[v].norm() + 1e-8);
    }
  }
}

TEST(SolidScene, WorksOnRefinedMeshesWithATumourByDensity) {
  const auto body = refined();
  for (const char* model : kSolids) {
    SceneDescription description =
        parse_scene(std::string("model: ") + model +
                    "\nmaterial: {young: [[60, 3e3], [255, 60e3]], poisson: 0.45}\n"
                    "anchors: [{plane: {axis: z, below: 20%}}]\n"
                    "tools: [{name: tool, shape: {sphere: 0.008}, mode: grasp}]\n"
                    "probes: {tumour: {density_above: 200}, top: [0, 0, 0.025]}\n"
                    "effects: [density_response, gravity]\n");
    Scene scene(description, body);
    const Vec3 top(0.0, 0.0, 0.030);
    EXPECT_FALSE(scene.step(ToolPose{top, true}, 0.0).not_converged);
    ASSERT_TRUE(scene.probes().at("tumour") && scene.probes().at("top"));
    const Vec3 tumour = *scene.probes().at("tumour"), place = *scene.probes().at("top");
    const StepReport report = scene.step(ToolPose{top - Vec3(0, 0, 0.006), true}, 0.01);
    EXPECT_FALSE(report.not_converged) << model << " " << report.residual;
    EXPECT_EQ(deformation_quality(*body, scene.state()).inverted, 0u);
    const double tumour_moved = tumour.z() - scene.probes().at("tumour")->z();
    const double place_moved = place.z() - scene.probes().at("top")->z();
    EXPECT_GT(tumour_moved, 1e-4);
    EXPECT_GT(place_moved, tumour_moved);
    // The tool is pushed up.
    EXPECT_GT(scene.tool_forces()[0]->z(), 0.0);
  }
}

TEST(SolidScene, TheSameBitsWithOneThreadAndTwo) {
  for (const char* model : kSolids) {
    std::vector<std::vector<Vec3>> results;
    for (const int threads : {1, 2}) {
      Scene scene(scene_of(model, "", "[gravity]"), block(), threads);
      scene.step(ToolPose{kEnd, true}, 0.0);
      scene.step(ToolPose{kEnd + Vec3(0, 0, 0.005), true}, 0.0);
      results.push_back(scene.state().positions);
    }
    EXPECT_EQ(results[0], results[1]);
  }
}

TEST(SolidScene, S2_AStepWithoutAnEquilibriumSaysSoAndKeepsTheLastState) {
  Scene scene(scene_of("neo_hookean", "solver: {tolerance: 1e-12, max_iterations: 1}\n"), block());
  scene.step(ToolPose{kEnd, true}, 0.0);
  const std::vector<Vec3> before = scene.state().positions;
  const StepReport report = scene.step(ToolPose{kEnd + Vec3(0.02, 0.01, 0.01), true}, 0.01);
  EXPECT_TRUE(report.not_converged);
  EXPECT_GT(report.residual, 1e-12);
  EXPECT_EQ(scene.state().positions, before);
}

TEST(SolidScene, S3_S7_WhatIsNotFiniteIsRefusedAndTheStateStays) {
  Scene scene(scene_of("corotational"), block(2));
  scene.step(ToolPose{kEnd, true}, 0.0);
  const std::vector<Vec3> before = scene.state().positions;
  EXPECT_EQ(refusal([&] {
              scene.step(ToolPose{{0, NAN, 0}, true}, 0.01);
            }).substr(0, 11),
            "E_NONFINITE");
  EXPECT_EQ(refusal([&] { scene.step(ToolPose{kEnd, true}, NAN); }).substr(0, 4), "E_DT");
  EXPECT_EQ(refusal([&] { scene.step(ToolPoses{}, 0.0); }).substr(0, 7), "E_PARAM");
  EXPECT_EQ(scene.state().positions, before);
  // A tool that flies away takes the tissue with it or is not followed; nothing gets lost.
  const StepReport report = scene.step(ToolPose{kEnd + Vec3(9e5, 0, 0), true}, 0.01);
  for (const Vec3& place : scene.state().positions) EXPECT_TRUE(place.allFinite());
  if (report.not_converged) {
    EXPECT_EQ(scene.state().positions, before);
  }
}

TEST(SolidScene, ScenesInTwoThreadsFindWhatTheyFindAlone) {
  const auto last_positions = [] {
    Scene scene(scene_of("linear"), block(8));
    for (int i = 0; i < 12; ++i) {
      const Vec3 aside(0.0, 0.001 * (i / 3), 0.0);
      scene.step(ToolPose{kEnd + aside, i % 3 != 2}, 0.0);
    }
    scene.step(ToolPose{kEnd, true}, 0.0);
    scene.step(ToolPose{kEnd + Vec3(0.004, 0.0, 0.0), true}, 0.0);
    return scene.state().positions;
  };
  const std::vector<Vec3> alone = last_positions();
  for (int i = 0; i < 3; ++i) {
    std::vector<Vec3> one, other;
    std::thread thread([&] { one = last_positions(); });
    other = last_positions();
    thread.join();
    EXPECT_EQ(one, alone);
    EXPECT_EQ(other, alone);
  }
}

TEST(SolidScene, WhereTissueFoldsTheStepSaysSo) {
  for (const char* model : {"corotational", "neo_hookean"}) {
    for (const char* effects : {"[]", "[inertia]"}) {
      Scene scene(scene_of(model, "", effects), block());
      EXPECT_FALSE(scene.step(ToolPose{kEnd, true}, 0.01).folded) << model << effects;
      EXPECT_FALSE(scene.step(ToolPose{kEnd + Vec3(0.002, 0, 0), true}, 0.01).folded) << model;
      // The end is pushed through the middle.
      const StepReport report = scene.step(ToolPose{kEnd - Vec3(0.05, 0, 0), true}, 0.01);
      EXPECT_GT(deformation_quality(scene.body(), scene.state()).inverted, 0u) << model << effects;
      EXPECT_TRUE(report.folded) << model << effects;
    }
  }
}

TEST(SolidScene, S4_S5_BodiesAndIslandsThatNothingHoldsAreRefusedAndListed) {
  const auto scene = [](const std::string& anchors) {
    return parse_scene("model: linear\nanchors: " + anchors);
  };
  EXPECT_EQ(refusal([&] { Scene(scene("[]"), block()); }).substr(0, 16), "E_UNCONSTRAINED:");
  // Two vertices, and three on a line, are hinges.
  EXPECT_EQ(refusal([&] { Scene(scene("[{vertices: [0, 1]}]"), block()); }).substr(0, 16),
            "E_UNCONSTRAINED:");
  EXPECT_EQ(refusal([&] { Scene(scene("[{vertices: [0, 1, 2]}]"), block()); }).substr(0, 16),
            "E_UNCONSTRAINED:");
  EXPECT_EQ(refusal([&] { Scene(scene("[{vertices: [0, 1, 7]}]"), block()); }), "");
  // A second block beside the first, which nothing holds.
  auto islands = std::make_shared<Body>(*block());
  const auto count = static_cast<std::uint32_t>(islands->rest.size());
  for (std::uint32_t v = 0; v < count; ++v) {
    islands->rest.push_back(islands->rest[v] + Vec3f(0.1f, 0.0f, 0.0f));
    islands->densities.push_back(1.0f);
  }
  for (std::size_t t = islands->tets.size(); t-- > 0;) {
    Tet tet = islands->tets[t];
    for (std::uint32_t& v : tet) v += count;
    islands->tets.push_back(tet);
    islands->tet_densities.push_back(1.0f);
  }
  const std::string text =
      refusal([&] { Scene(scene("[{plane: {axis: x, below: 0.01}}]"), islands); });
  EXPECT_NE(text.find("E_UNCONSTRAINED: anchors: 1 parts"), std::string::npos) << text;
  EXPECT_NE(text.find("around vertex " + std::to_string(count)), std::string::npos) << text;
}

TEST(SolidScene, AnchorsOfEveryKindHoldWhatTheySay) {
  const auto body = block(3);  // 7 x 4 x 4 vertices
  const auto held = [&](const std::string& anchors) {
    std::size_t count = 0;
    const SceneDescription scene = parse_scene("model: linear\nanchors: " + anchors);
    for (const int anchor : anchors_of_vertices(*body, scene.anchors)) count += anchor != kNobody;
    return count;
  };
  EXPECT_EQ(held("[{plane: {axis: x, below: 0.001}}]"), 16u);
  EXPECT_EQ(held("[{plane: {axis: x, above: 90%}}]"), 16u);
  EXPECT_EQ(held("[{box: {low: [0%, 0%, 0%], high: [100%, 100%, 10%]}}]"), 28u);
  EXPECT_EQ(held("[{sphere: {centre: [0, 0, 0], radius: 0.0101}}]"), 4u);
  EXPECT_EQ(held("[{label: 1}]"), body->rest.size());
  EXPECT_EQ(held("[{vertices: [3, 5, 3]}]"), 2u);
  EXPECT_EQ(refusal([&] { held("[{sphere: {centre: [9, 9, 9], radius: 0.01}}]"); }),
            "E_SCENE: anchors[0]: holds no vertex of the mesh");
  EXPECT_EQ(refusal([&] { held("[{vertices: [112]}]"); }),
            "E_SCENE: anchors: vertex 112 is not one of the mesh's 112");
  for (const char* bad :
       {"[{plane: {axis: w, below: 1}}]", "[{plane: {axis: x}}]",
        "[{plane: {axis: x, below: 1, above: 2}}]", "[{plane: {axis: x, below: 120%}}]",
        "[{box: {low: [0, 0], high: [1, 1, 1]}}]", "[{vertices: [1.5]}]", "[{vertices: [-1]}]"}) {
    EXPECT_NE(refusal([&] { held(bad); }).find("line 2"), std::string::npos) << bad;
  }
}

TEST(SolidScene, WhatAModelCannotHaveIsSaid) {
  EXPECT_EQ(
      refusal([] { scene_of("linear", "", "[recovery]"); }),
      "E_SCENE: scene: line 5, effects[0]: 'recovery' is not an effect of model linear, which "
      "knows density_response gravity inertia damping near_incompressibility "
      "rigid_inclusions contact force_feedback");
  EXPECT_NE(refusal([] {
              parse_scene("model: linear\ntools: [{name: a, mode: press}]");
            }).find("needs the effect contact"),
            std::string::npos);
  EXPECT_NE(refusal([] {
              parse_scene("model: linear\ntools: [{name: a, mode: grasp}, {name: a, mode: grasp}]");
            }).find("second tool 'a'"),
            std::string::npos);
}

TEST(SolidScene, EffectsThatAreNotNamedHaveNoCost) {
  Scene bare(scene_of("linear"), block());
  EXPECT_TRUE(bare.effect_costs().empty());
  Scene heavy(scene_of("linear", "", "[gravity]"), block());
  ASSERT_EQ(heavy.effect_costs().size(), 1u);
  EXPECT_EQ(heavy.effect_costs()[0].name, "gravity");
  EXPECT_GT(heavy.effect_costs()[0].bytes, 0u);
}

TEST(SolidScene, TheReadmesTableOfEffectsIsTheCodes) {
  std::ifstream file(std::string(TISSUE_SOURCE_DIR) + "/README.md");
  std::stringstream readme;
  readme << file.rdbuf();
  EXPECT_NE(readme.str().find(effects_table()), std::string::npos)
      << "the README needs this table:\n"
      << effects_table();
}

}  // namespace
