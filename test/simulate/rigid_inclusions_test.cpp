// Tumours that move as rigid bodies.
#include "support/bodies.h"
#include "support/mesh_checks.h"
#include "tissue/simulate/multigrid_system.h"
#include "tissue/simulate/rigid_inclusions.h"
#include "tissue/simulate/scene_file.h"

#include <Eigen/Geometry>

namespace {

using namespace tissue;
using tissue_test::refusal;

// A block of 0.1 m with a ball of 30 mm radius of dense tissue in its middle.
std::shared_ptr<const Body> block(int cells) {
  Body body =
      tissue_test::with_core(tissue_test::kuhn_block({cells, cells, cells}, {0.1, 0.1, 0.1}, 1),
                             Vec3::Constant(0.05), 0.03, 255.0f, 60.0f);
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    if (body.tet_densities[t] < 255.0f) continue;
    for (const std::uint32_t v : body.tets[t]) body.densities[v] = 255.0f;
  }
  return std::make_shared<Body>(body);
}

std::shared_ptr<const Body> refined() {
  static const auto body = std::make_shared<Body>(body_of(tissue_test::refined_ball(0.014)));
  return body;
}

SceneDescription scene_of(const std::string& model, int order, const std::string& effects,
                          double hard = 3e7) {
  return parse_scene("model: " + model + "\nelement_order: " + std::to_string(order) +
                     "\nmaterial: {young: [[199, 3e3], [201, " + std::to_string(hard) +
                     "]], poisson: 0.45}\nanchors: [{plane: {axis: z, below: 12%}}]\n"
                     "tools: [{name: tool, shape: {pad: {radius: 0.02}}, mode: grasp}]\n"
                     "probes: {tumour: {density_above: 200}}\nsolver: {tolerance: 1e-5}\n"
                     "effects: [density_response" +
                     effects + "]\n");
}

const std::string kRigid = ", {rigid_inclusions: {density_above: 200}}";

ToolPose pose(const Vec3& start, int step) {
  return {start + step * Vec3(0.002, 0.0, -0.002), true,
          Eigen::Quaterniond(Eigen::AngleAxisd(0.1 * step, Vec3::UnitY()))};
}

// Relative difference of the displacements of all vertices.
double difference(const Scene& one, const Scene& other) {
  double squares = 0.0, all = 0.0;
  for (std::size_t v = 0; v < one.body().rest.size(); ++v) {
    const Vec3 place = one.state().positions[v];
    squares += (place - other.state().positions[v]).squaredNorm();
    all += (place - one.body().rest[v].cast<double>()).squaredNorm();
  }
  return std::sqrt(squares / all);
}

// How far distances in the tumour are from what they were.
double stretch(const Scene& scene, float density = 200.0f) {
  double worst = 0.0;
  const std::vector<Tet>& tets = scene.body().tets;
  for (std::size_t t = 0; t < tets.size(); ++t) {
    if (!(scene.body().tet_densities[t] > density)) continue;
    for (int k = 1; k < 4; ++k) {
      const double rest = (scene.body().rest[tets[t][k]] - scene.body().rest[tets[t][0]]).norm();
      const double now =
          (scene.state().positions[tets[t][k]] - scene.state().positions[tets[t][0]]).norm();
      worst = std::max(worst, std::abs(now / rest - 1.0));
    }
  }
  return worst;
}

TEST(RigidInclusions, AnswerAsATumourTenThousandTimesStifferWithFewerUnknowns) {
  for (const char* model : {"mass_spring", "linear", "corotational", "neo_hookean"}) {
    for (const int order : {1, 2}) {
      if (order == 2 && std::string(model) == "mass_spring") continue;
      for (const char* more : {"", ", {inertia: {iterations: 20}}, damping"}) {
        // With inertia springs buckle here one way or another.
        if (std::string(model) == "mass_spring" && *more != 0) continue;
        for (const bool is_refined : {false, order == 1}) {
          const auto body = is_refined ? refined() : block(order == 1 ? 8 : 4);
          const Vec3 start = is_refined ? Vec3(0.01, 0.002, 0.03) : Vec3(0.06, 0.052, 0.1);
          Scene hard(scene_of(model, order, more), body),
              rigid(scene_of(model, order, kRigid + more), body);
          std::size_t unknowns[2] = {};
          for (int step = 0; step < 4; ++step) {
            const StepReport one = hard.step(pose(start, step), 0.02),
                             other = rigid.step(pose(start, step), 0.02);
            EXPECT_FALSE(one.not_converged || other.not_converged) << model << order << more;
            unknowns[0] = one.unknowns;
            unknowns[1] = other.unknowns;
          }
          EXPECT_LE(difference(hard, rigid), 0.01) << model << order << more << is_refined;
          const Vec3 force = *hard.tool_forces()[0];
          EXPECT_LE((force - *rigid.tool_forces()[0]).norm(), 0.01 * force.norm())
              << model << order << more << is_refined;
          EXPECT_LT(unknowns[1], unknowns[0]);
          const double tolerance = std::string(model) == "linear" ? 5e-3 : 1e-6;
          EXPECT_LE(stretch(rigid), tolerance) << model << order << more;
        }
      }
    }
  }
}

// A heavy ball in soft tissue.
TEST(RigidInclusions, HaveWeightAndFallAsTheRestDoes) {
  for (const int order : {1, 2}) {
    const auto body = block(4);
    Scene hard(scene_of("corotational", order, ", gravity"), body),
        rigid(scene_of("corotational", order, ", gravity" + kRigid), body);
    for (Scene* scene : {&hard, &rigid}) scene->step(ToolPoses{std::nullopt}, 0.0);
    EXPECT_LE(difference(hard, rigid), 0.01);
    // Nothing holds it.
    SceneDescription free = scene_of("corotational", order, ", gravity, inertia" + kRigid);
    free.anchors.clear();
    Scene falling(free, body);
    constexpr int kSteps = 10;
    constexpr double h = 0.01;
    for (int i = 0; i < kSteps; ++i) falling.step(ToolPoses{std::nullopt}, h);
    const Vec3 fall(0.0, 0.0, -9.81 * h * h * kSteps * (kSteps + 1) / 2);
    double worst = 0.0;
    for (std::size_t v = 0; v < body->rest.size(); ++v) {
      const Vec3 moved = falling.state().positions[v] - body->rest[v].cast<double>();
      worst = std::max(worst, (moved - fall).norm());
    }
    // For iterations, as far as those go.
    EXPECT_LE(worst, 1e-3 * fall.norm()) << order;
  }
}

TEST(RigidInclusions, GoWithOtherEffects) {
  // The tumour of a ball this coarse is no denser.
  constexpr float kDense = 120.0f;
  const auto ball = std::make_shared<Body>(body_of(tissue_test::refined_ball(0.016)));
  struct Case {
    std::string model;
    int order;
    std::string more;
  };
  for (const auto& [model, order, more] :
       {Case{"corotational", 1, ", force_feedback"}, Case{"neo_hookean", 2, ""},
        Case{"neo_hookean", 1, ", inertia, damping"}}) {
    SceneDescription description = parse_scene(
        "model: " + model + "\nelement_order: " + std::to_string(order) +
        "\nmaterial: {young: [[60, 3e3], [255, 60e3]], poisson: 0.49, mass_density: 1000}\n"
        "anchors: [{plane: {axis: z, below: 20%}}]\n"
        "tools: [{name: finger, shape: {sphere: 0.01}, mode: press}]\n"
        "probes: {tumour: {density_above: 120}}\n"
        "effects: [density_response, {gravity: {vector: [0, 0, -1]}}, contact, "
        "near_incompressibility, {rigid_inclusions: {density_above: 120}}" +
        more + "]\n");
    // Large ones take long with quadratic tets.
    Scene scene(description, order == 1 ? ball : block(4));
    const Vec3 top = order == 1 ? Vec3(0.002, 0.001, 0.03) : Vec3(0.052, 0.051, 0.1);
    const Vec3 before = *scene.probes().at("tumour");
    StepReport report;
    for (const double height : {0.002, -0.003, -0.006}) {
      report = scene.step(ToolPose{top + Vec3(0.0, 0.0, 0.01 + height)}, 0.02);
      EXPECT_FALSE(report.not_converged || report.clamped) << model << order << more << height;
    }
    EXPECT_LE(report.penetration, 1e-4);
    EXPECT_GT(scene.tool_forces()[0]->z(), 0.05);
    EXPECT_LT(scene.probes().at("tumour")->z(), before.z() - 1e-4);
    EXPECT_LE(stretch(scene, kDense), 1e-6);
    EXPECT_EQ(scene.effect_costs().size(), description.effects.size());
  }
}

TEST(RigidInclusions, AreHeldAsAWhole) {
  const auto body = block(4);
  // A sphere about a corner of the tumour.
  SceneDescription description = scene_of("corotational", 2, kRigid);
  description.tools[0].shape = ToolShape::kSphere;
  description.tools[0].radius = 0.026;
  Scene scene(description, body);
  scene.step(ToolPose{Vec3(0.05, 0.05, 0.1), true}, 0.0);
  const Vec3 before = *scene.probes().at("tumour"), moved(0.003, 0.0, 0.004);
  EXPECT_FALSE(scene.step(ToolPose{Vec3(0.05, 0.05, 0.1) + moved, true}, 0.0).not_converged);
  EXPECT_LE((*scene.probes().at("tumour") - before - moved).norm(), 1e-9);
  scene.step(ToolPose{Vec3(0.05, 0.05, 0.1) + moved, false}, 0.0);
  EXPECT_LE((*scene.probes().at("tumour") - before).norm(), 1e-5);
  // An anchor at one of its vertices.
  SphereAnchor anchor;
  anchor.centre = {Coordinate{0.05, false}, Coordinate{0.05, false}, Coordinate{0.025, false}};
  anchor.radius = Coordinate{0.001, false};
  description.anchors.push_back(anchor);
  Scene anchored(description, body);
  anchored.step(ToolPose{Vec3(0.0, 0.0, 0.1), true}, 0.0);
  anchored.step(ToolPose{Vec3(0.01, 0.0, 0.1), true}, 0.0);
  EXPECT_EQ(*anchored.probes().at("tumour"), before);
}

TEST(RigidInclusions, WhatMakesNoSenseIsRefused) {
  const auto body = block(4);
  const auto scene = [](const std::string& parameters) {
    return parse_scene(
        "model: linear\nanchors: [{plane: {axis: z, below: 5%}}]\n"
        "effects: [{rigid_inclusions: {" +
        parameters + "}}]\n");
  };
  EXPECT_EQ(refusal([&] { Scene(scene("density_above: 10"), body); }),
            "E_PARAM: rigid_inclusions: density_above 10 leaves nothing of the body to deform");
  EXPECT_NE(refusal([&] { scene("density_above: -1"); }).find("density_above"), std::string::npos);
  Body silent = *body;
  silent.tet_densities.clear();
  EXPECT_NE(refusal([&] {
              Scene(scene("density_above: 200"), std::make_shared<Body>(silent));
            }).find("does not say the densities"),
            std::string::npos);
  // Nothing is that dense: everything deforms.
  Scene none(scene("density_above: 256"), body);
  EXPECT_FALSE(none.step(ToolPoses{}, 0.0).not_converged);
}

}  // namespace
