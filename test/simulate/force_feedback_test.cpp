// What tools feel.
#include "support/bodies.h"
#include "support/mesh_checks.h"
#include "tissue/simulate/scene_file.h"

namespace {

using namespace tissue;

std::shared_ptr<const Body> block() {
  return std::make_shared<Body>(tissue_test::kuhn_block({6, 4, 4}, {0.06, 0.04, 0.04}));
}

bool presses(const std::string& shape) { return shape.find("press") != std::string::npos; }

// A block that is held at x = 0, or lies on a soft bed, and a tool at its other end.
SceneDescription scene_of(const std::string& model, int order, const std::string& shape,
                          const std::string& effects = "") {
  return parse_scene("model: " + model + "\nelement_order: " + std::to_string(order) +
                     "\nmaterial: {young: [[0, 5e3]], poisson: 0.4}\n"
                     "anchors: [{plane: {axis: x, below: 10%}}]\n"
                     "tools: [{name: tool, shape: " +
                     shape + "}]\nsolver: {tolerance: 1e-10}\neffects: [force_feedback" +
                     (presses(shape) ? ", contact" : "") + effects + "]\n");
}

const std::string kSphere = "{sphere: 0.012}, mode: grasp",
                  kPad = "{pad: {radius: 0.015}}, mode: grasp",
                  kBall = "{sphere: 0.012}, mode: press",
                  kCapsule = "{capsule: {radius: 0.012, length: 0.01}}, mode: press";
const Vec3 kEnd(0.06, 0.021, 0.019);

// Where the tool starts, and how it moves. What presses does so from outside, its shaft aside.
ToolPose at(const std::string& shape, const Vec3& motion, double angle = 0.0) {
  const Vec3 start = presses(shape) ? Vec3(kEnd + 0.012 * Vec3::UnitX()) : kEnd;
  return {start + motion, true,
          // A shaft along edges of the mesh may touch them anywhere.
          Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec3(1.0, 2.0, -1.0).normalized()) *
                             Eigen::AngleAxisd(0.2, Vec3(3.0, -1.0, 2.0).normalized()))};
}
Vec3 motion_of(const std::string& shape) {
  return presses(shape) ? Vec3(-0.003, 0.0005, -0.001) : Vec3(0.001, 0.0005, -0.002);
}

// Calls body(model, order, shape of the tool) for all that there are.
template <class Body>
void for_each_case(const Body& body) {
  for (const char* model : {"mass_spring", "linear", "corotational", "neo_hookean"}) {
    for (const int order : {1, 2}) {
      if (order == 2 && std::string(model) == "mass_spring") continue;
      for (const std::string& shape : {kSphere, kPad, kBall, kCapsule}) body(model, order, shape);
    }
  }
}

TEST(ForceFeedback, ForceAndTorqueAreTheEnergysDerivativesAlongTheToolsMotion) {
  for_each_case([](const std::string& model, int order, const std::string& shape) {
    Scene scene(scene_of(model, order, shape), block());
    scene.step(at(shape, Vec3::Zero()), 0.0);
    const Vec3 motion = motion_of(shape);
    const auto energy = [&](const Vec3& moved, double angle) {
      const StepReport report = scene.step(at(shape, moved, angle), 0.01);
      EXPECT_FALSE(report.not_converged) << model << order;
      return *report.energy;
    };
    constexpr double kStep = 1e-5, kTurn = 1e-4;
    Vec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 aside = kStep * Vec3::Unit(axis);
      slope[axis] = (energy(motion + aside, 0.0) - energy(motion - aside, 0.0)) / (2.0 * kStep);
    }
    const double turning = (energy(motion, kTurn) - energy(motion, -kTurn)) / (2.0 * kTurn);
    energy(motion, 0.0);
    ASSERT_TRUE(scene.tool_feedback()[0]);
    const Wrench felt = scene.tool_feedback()[0]->wrench;
    EXPECT_LE((felt.force + slope).norm(), 1e-4 * slope.norm()) << model << order << shape;
    EXPECT_NEAR(felt.torque.dot(Vec3(1.0, 2.0, -1.0).normalized()), -turning,
                1e-3 * felt.torque.norm() + 1e-12)
        << model << order << shape;
    // What the anchors bear.
    EXPECT_LE((felt.force + scene.anchor_forces()[0]).norm(), 1e-6 * felt.force.norm())
        << model << order << shape;
    // Of where the nodes are, which a superposition knows in single precision only; what is felt
    // comes in double precision straight from how the tool moved.
    const double precise = model == "linear" && shape == kSphere ? 1e-6 : 1e-12;
    EXPECT_LE((felt.force - *scene.tool_forces()[0]).norm(), precise * felt.force.norm());
  });
}

TEST(ForceFeedback, ComplianceIsAFiniteDifferenceOfTheStep) {
  for_each_case([](const std::string& model, int order, const std::string& shape) {
    Scene scene(scene_of(model, order, shape), block());
    scene.step(at(shape, Vec3::Zero()), 0.0);
    const Vec3 motion = motion_of(shape);
    scene.step(at(shape, motion), 0.01);
    const Mat3 compliance = scene.tool_feedback()[0]->compliance;
    constexpr double kStep = 2e-5;
    Mat3 stiffness;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 aside = kStep * Vec3::Unit(axis);
      scene.step(at(shape, motion + aside), 0.01);
      stiffness.col(axis) = -*scene.tool_forces()[0];
      scene.step(at(shape, motion - aside), 0.01);
      stiffness.col(axis) += *scene.tool_forces()[0];
    }
    stiffness /= 2.0 * kStep;
    // What only touches is hardly held aside, and may be pushed away.
    EXPECT_LE((stiffness - compliance.inverse()).norm(), 0.02 * stiffness.norm())
        << model << order << shape << "\n"
        << stiffness << "\n"
        << compliance.inverse();
    if (presses(shape)) return;
    EXPECT_LE((stiffness * compliance - Mat3::Identity()).norm(), model == "linear" ? 1e-3 : 2e-3)
        << model << order << shape << "\n"
        << stiffness * compliance;
    EXPECT_GT(compliance.diagonal().minCoeff(), 0.0);
  });
}

TEST(ForceFeedback, IsThereForToolsThatHoldSomethingAndOnlyInScenesThatNameIt) {
  SceneDescription bare = scene_of("corotational", 1, kSphere);
  bare.effects.clear();
  Scene without(bare, block());
  without.step(at(kSphere, Vec3::Zero()), 0.0);
  without.step(at(kSphere, motion_of(kSphere)), 0.01);
  EXPECT_TRUE(without.tool_feedback().empty());
  EXPECT_TRUE(without.effect_costs().empty());
  for (const std::string& shape : {kSphere, kPad, kBall}) {
    Scene scene(scene_of("corotational", 1, shape, ", inertia, damping"), block());
    scene.step(at(shape, Vec3::Zero()), 0.0);
    for (int i = 0; i < 3; ++i) scene.step(at(shape, motion_of(shape)), 0.01);
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
