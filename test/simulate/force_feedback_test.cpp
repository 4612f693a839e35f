// What tools feel.
#include "support/bodies.h"
#include "support/mesh_checks.h"
#include "tissue/simulate/scene_file.h"

namespace {

using namespace tissue;

std::shared_ptr<const Body> block() {
  return std::make_shared<Body>(tissue_test::kuhn_block({6, 4, 4}, {0.06, 0.04, 0.04}));
}

// A block that is held at x = 0, or lies on a soft bed, and a tool at its other end.
SceneDescription scene_of(const std::string& model, int order, const std::string& shape,
                          const std::string& effects = "[force_feedback]") {
  return parse_scene("model: " + model + "\nelement_order: " + std::to_string(order) +
                     "\nmaterial: {young: [[0, 5e3]], poisson: 0.4}\n"
                     "anchors: [{plane: {axis: x, below: 10%}}]\n"
                     "tools: [{name: tool, shape: " +
                     shape +
                     ", mode: grasp}]\n"
                     "solver: {tolerance: 1e-10}\neffects: " +
                     effects + "\n");
}

const char* const kSphere = "{sphere: 0.012}";
const char* const kPad = "{pad: {radius: 0.015}}";
const Vec3 kEnd(0.06, 0.021, 0.019);
const Vec3 kMotion(0.001, 0.0005, -0.002);

ToolPose at(const Vec3& motion, double angle = 0.0) {
  return {kEnd + motion, true,
          Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec3(1.0, 2.0, -1.0).normalized()))};
}

// Calls body(model, order, shape of the tool) for all that there are.
template <class Body>
void for_each_case(const Body& body) {
  for (const char* model : {"mass_spring", "linear", "corotational", "neo_hookean"}) {
    for (const int order : {1, 2}) {
      if (order == 2 && std::string(model) == "mass_spring") continue;
      for (const char* shape : {kSphere, kPad}) body(model, order, shape);
    }
  }
}

TEST(ForceFeedback, ForceAndTorqueAreTheEnergysDerivativesAlongTheToolsMotion) {
  for_each_case([](const std::string& model, int order, const char* shape) {
    Scene scene(scene_of(model, order, shape), block());
    scene.step(at(Vec3::Zero()), 0.0);
    const auto energy = [&](const Vec3& motion, double angle) {
      const StepReport report = scene.step(at(motion, angle), 0.01);
      EXPECT_FALSE(report.not_converged) << model << order;
      return *report.energy;
    };
    constexpr double kStep = 1e-5, kTurn = 1e-4;
    Vec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 aside = kStep * Vec3::Unit(axis);
      slope[axis] = (energy(kMotion + aside, 0.0) - energy(kMotion - aside, 0.0)) / (2.0 * kStep);
    }
    const double turning = (energy(kMotion, kTurn) - energy(kMotion, -kTurn)) / (2.0 * kTurn);
    energy(kMotion, 0.0);
    ASSERT_TRUE(scene.tool_feedback()[0]);
    const Wrench felt = scene.tool_feedback()[0]->wrench;
    EXPECT_LE((felt.force + slope).norm(), 1e-4 * slope.norm()) << model << order << shape;
    EXPECT_NEAR(felt.torque.dot(Vec3(1.0, 2.0, -1.0).normalized()), -turning,
                1e-3 * felt.torque.norm())
        << model << order << shape;
    // What the anchors bear.
    EXPECT_LE((felt.force + scene.anchor_forces()[0]).norm(), 1e-6 * felt.force.norm())
        << model << order << shape;
    EXPECT_LE((felt.force - *scene.tool_forces()[0]).norm(), 1e-12 * felt.force.norm());
  });
}

TEST(ForceFeedback, ComplianceIsAFiniteDifferenceOfTheStep) {
  for_each_case([](const std::string& model, int order, const char* shape) {
    Scene scene(scene_of(model, order, shape), block());
    scene.step(at(Vec3::Zero()), 0.0);
    scene.step(at(kMotion), 0.01);
    const Mat3 compliance = scene.tool_feedback()[0]->compliance;
    constexpr double kStep = 2e-5;
    Mat3 stiffness;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 aside = kStep * Vec3::Unit(axis);
      scene.step(at(kMotion + aside), 0.01);
      stiffness.col(axis) = -*scene.tool_forces()[0];
      scene.step(at(kMotion - aside), 0.01);
      stiffness.col(axis) += *scene.tool_forces()[0];
    }
    stiffness /= 2.0 * kStep;
    // Iterations solve to a thousandth, and where tissue is compressed the Hessian leaves out
    // what would make it indefinite; of springs that is more.
    const double slack = model == "linear" ? 1e-3 : model == "mass_spring" ? 0.05 : 0.02;
    EXPECT_LE((stiffness * compliance - Mat3::Identity()).norm(), slack)
        << model << order << shape << "\n"
        << stiffness * compliance;
    EXPECT_GT(compliance.diagonal().minCoeff(), 0.0);
  });
}

TEST(ForceFeedback, IsThereForToolsThatHoldSomethingAndOnlyInScenesThatNameIt) {
  Scene without(scene_of("corotational", 1, kSphere, "[]"), block());
  without.step(at(Vec3::Zero()), 0.0);
  without.step(at(kMotion), 0.01);
  EXPECT_TRUE(without.tool_feedback().empty());
  EXPECT_TRUE(without.effect_costs().empty());
  for (const char* shape : {kSphere, kPad}) {
    Scene scene(scene_of("corotational", 1, shape, "[force_feedback, inertia, damping]"), block());
    scene.step(at(Vec3::Zero()), 0.0);
    for (int i = 0; i < 3; ++i) scene.step(at(kMotion), 0.01);
    ASSERT_TRUE(scene.tool_feedback()[0]);
    EXPECT_GT(scene.tool_feedback()[0]->wrench.force.norm(), 1e-3);
    EXPECT_EQ(scene.effect_costs()[0].name, "force_feedback");
    EXPECT_GT(scene.effect_costs()[0].seconds, 0.0);
    scene.step(std::nullopt, 0.01);
    EXPECT_FALSE(scene.tool_feedback()[0]);
    scene.reset();
    EXPECT_TRUE(scene.tool_feedback().empty());
  }
  EXPECT_NE(tissue_test::refusal([] {
              parse_scene("model: closed_form\neffects: [force_feedback]\n");
            }).find("not an effect of model closed_form"),
            std::string::npos);
}

}  // namespace
