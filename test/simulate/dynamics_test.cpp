// Tissue with inertia: scenes that go on in time.
#include "support/bodies.h"
#include "support/mesh_checks.h"
#include "support/problem.h"
#include "tissue/simulate/damping.h"
#include "tissue/simulate/inertia.h"
#include "tissue/simulate/scene_file.h"
#include "tissue/simulate/spring_energy.h"

#include <random>

namespace {

using namespace tissue;
using tissue_test::refusal;

std::shared_ptr<const Body> beam(int cells) {
  return std::make_shared<Body>(
      tissue_test::kuhn_block({2 * cells, cells, cells}, {0.2, 0.1, 0.1}));
}

const char* const kModels[] = {"mass_spring", "linear", "corotational", "neo_hookean"};

SceneDescription scene_of(const std::string& model, const std::string& effects,
                          const std::string& more = "") {
  return parse_scene("model: " + model + "\neffects: " + effects + "\n" +
                     "material: {young: [[0, 50e3]], poisson: 0.45, mass_density: 1000}\n" + more);
}
const std::string kClamped = "anchors: [{plane: {axis: x, below: 0.001}}]\n";
const std::string kGrasp = "tools: [{name: tool, shape: {sphere: 0.03}, mode: grasp}]\n";

ToolPoses no_tools(const Scene& scene) { return ToolPoses(scene.description().tools.size()); }

TEST(Dynamics, AFreeBodyFallsAsImplicitEulerDoesExactly) {
  for (const char* model : kModels) {
    for (const int order : {1, 2}) {
      if (order == 2 && model == kModels[0]) continue;
      const auto body = beam(2);
      Scene scene(scene_of(model, "[inertia, gravity]", "element_order: " + std::to_string(order)),
                  body);
      constexpr int kSteps = 20;
      constexpr double h = 0.01;
      for (int i = 0; i < kSteps; ++i) {
        EXPECT_FALSE(scene.step(no_tools(scene), h).not_converged);
      }
      // v_n = n g h and x_n = g h² (1 + … + n).
      const Vec3 fall(0.0, 0.0, -9.81 * h * h * kSteps * (kSteps + 1) / 2);
      for (std::size_t v = 0; v < body->rest.size(); ++v) {
        const Vec3 moved = scene.state().positions[v] - body->rest[v].cast<double>();
        EXPECT_LE((moved - fall).norm(), 1e-9 * fall.norm()) << model << order;
        EXPECT_LE((scene.state().velocities[v] - Vec3(0, 0, -9.81 * h * kSteps)).norm(), 1e-8);
      }
    }
  }
}

TEST(Dynamics, ABeamSettlesWhereStaticsHasIt) {
  for (const char* model : kModels) {
    const auto body = beam(3);
    const std::string solver = "solver: {tolerance: 1e-9}\n";
    Scene still(scene_of(model, "[gravity]", kClamped + solver), body);
    still.step(no_tools(still), 0.0);
    Scene swinging(
        scene_of(model, "[gravity, inertia, {damping: {mass: 20, stiffness: 0.01}}]", kClamped),
        body);
    EXPECT_TRUE(swinging.recovering());
    for (int i = 0; i < 300; ++i) swinging.step(no_tools(swinging), 0.02);
    EXPECT_FALSE(swinging.recovering());
    for (std::size_t v = 0; v < body->rest.size(); ++v) {
      EXPECT_LE((still.state().positions[v] - swinging.state().positions[v]).norm(), 1e-6) << model;
    }
  }
}

// Half of the first period of a beam that starts to sag: when its end is lowest [s].
double half_period(int cells) {
  Scene scene(scene_of("linear", "[gravity, {inertia: {substep: 0.001}}]",
                       kClamped + "element_order: 2\nprobes: {end: [0.2, 0.05, 0.05]}\n"),
              beam(cells));
  double before = 0.0, here = 0.0;
  for (int i = 0;; ++i) {
    scene.step(no_tools(scene), 0.001);
    const double next = scene.probes().at("end")->z();
    if (i > 5 && next > here) {
      // The vertex of the parabola through three instants.
      const double back = before - here, on = next - here;
      return 0.001 * (i + 0.5 * (back - on) / (back + on));
    }
    before = here;
    here = next;
  }
}

TEST(Dynamics, TheFirstBendingModeHasItsFrequency) {
  const double coarse = half_period(4), fine = half_period(6);
  EXPECT_NEAR(coarse, fine, 0.02 * fine);
  // A slender beam of this kind (Euler and Bernoulli) swings faster than one that also shears.
  const double slender = 0.5 * 2.0 * M_PI * 0.04 / (1.8751 * 1.8751) *
                         std::sqrt(1000.0 * 0.01 / (50e3 * std::pow(0.1, 4) / 12.0));
  EXPECT_GT(fine, slender);
  EXPECT_LT(fine, 1.3 * slender);
}

// Plucked at its end and released: with steps that are iterated to convergence, energy never grows.
void expect_no_gain(const std::string& model, double dt, const std::string& damping, int steps) {
  const auto body = beam(1);
  const std::string effects =
      "[{inertia: {substep: " + std::to_string(dt) + ", iterations: 50}}" + damping + "]";
  Scene scene(scene_of(model, effects, kClamped + kGrasp + "solver: {tolerance: 1e-10}\n"), body);
  const Vec3 end(0.2, 0.1, 0.1);
  scene.step(ToolPose{end, true}, dt);
  for (int i = 1; i <= 5; ++i) scene.step(ToolPose{end + Vec3(0, 0, 0.006 * i), true}, dt);
  StepReport report = scene.step(ToolPose{end + Vec3(0, 0, 0.03), false}, dt);
  const double start = *report.energy;
  for (int i = 0; i < steps; ++i) {
    report = scene.step(ToolPose{end, false}, dt);
    ASSERT_FALSE(report.not_converged) << model << " " << dt << " " << i << " " << report.residual
                                       << " it " << report.iterations << " E " << *report.energy;
    ASSERT_LE(*report.energy, start * (1.0 + 1e-6) + 1e-12) << model << " " << dt << " " << i;
  }
}

TEST(Dynamics, T8_EnergyNeverGrowsAfterAPluck) {
  for (const char* model : kModels) {
    for (const double dt : {1e-3, 1e-2, 1e-1, 10.0}) {
      for (const char* damping : {"", ", {damping: {mass: 2, stiffness: 0.002}}"}) {
        expect_no_gain(model, dt, damping, dt == 1e-2 ? 10000 : 500);
      }
    }
  }
}

TEST(Dynamics, S7_AStepThatOverflowsSaysSoAndKeepsTheLastState) {
  const Vec3 end(0.2, 0.05, 0.05);
  for (const char* model : kModels) {
    Scene scene(scene_of(model, "[inertia, damping]", kClamped + kGrasp), beam(2));
    scene.step(ToolPose{end, true}, 0.01);
    scene.step(ToolPose{end + Vec3(0.0, 0.01, 0.0), true}, 0.01);
    const std::vector<Vec3> before = scene.state().positions;
    // Masses over squares of such a time are no numbers.
    EXPECT_TRUE(scene.step(ToolPose{end, true}, 1e-200).not_converged) << model;
    EXPECT_EQ(scene.state().positions, before) << model;
    EXPECT_EQ(refusal([&] {
                scene.step(ToolPose{end * 1e200, true}, 0.01);
              }),
              "E_PARAM: pose: that of tool tool is farther than 1e+06 m away");
    EXPECT_EQ(scene.state().positions, before) << model;
    EXPECT_FALSE(scene.step(ToolPose{end, true}, 0.01).not_converged) << model;
    for (const Vec3& place : scene.state().positions) EXPECT_LE(place.norm(), 1.0) << model;
  }
}

// Also where solvers keep what they found earlier to be quicker.
TEST(Dynamics, AfterAResetTheSameStepsHaveTheSameBits) {
  const auto body =
      std::make_shared<Body>(tissue_test::kuhn_block({16, 8, 8}, Vec3(0.2, 0.1, 0.1), 2));
  for (const char* order : {"1", "2"}) {
    Scene scene(scene_of(std::string("corotational\nelement_order: ") + order, "[inertia, gravity]",
                         kClamped),
                body, 1);
    const auto run = [&] {
      for (int i = 0; i < 6; ++i) scene.step(no_tools(scene), 0.02);
      return scene.state().positions;
    };
    const std::vector<Vec3> first = run();
    scene.reset();
    EXPECT_EQ(first, run());
  }
}

TEST(Dynamics, NoTimeNoMotionAndTheSameBitsWithTwoThreads) {
  std::vector<std::vector<Vec3>> results;
  for (const int threads : {1, 2}) {
    const auto body = beam(2);
    Scene scene(scene_of("corotational", "[inertia, gravity]", kClamped), body, threads);
    scene.step(no_tools(scene), 0.0);
    for (std::size_t v = 0; v < body->rest.size(); ++v) {
      EXPECT_EQ(scene.state().positions[v], body->rest[v].cast<double>());
    }
    // Three substeps of 20 ms each are three steps of 20 ms.
    scene.step(no_tools(scene), 0.06);
    results.push_back(scene.state().positions);
    scene.reset();
    for (int i = 0; i < 3; ++i) scene.step(no_tools(scene), 0.02);
    for (std::size_t v = 0; v < body->rest.size(); ++v) {
      EXPECT_LE((scene.state().positions[v] - results.back()[v]).norm(), 1e-12);
    }
  }
  EXPECT_EQ(results[0], results[1]);
}

TEST(Dynamics, WhatHasNoMeaningIsSaid) {
  EXPECT_NE(refusal([] { scene_of("linear", "[damping]"); }).find("names damping without inertia"),
            std::string::npos);
  EXPECT_NE(refusal([] { scene_of("linear", "[{inertia: {substep: 0}}]"); }).find("substep"),
            std::string::npos);
  EXPECT_NE(refusal([] {
              scene_of("mass_spring", "[]", "element_order: 2");
            }).find("needs tissue as a solid"),
            std::string::npos);
  // With inertia a body may fly; without, it may not.
  EXPECT_EQ(refusal([] { Scene(scene_of("linear", "[inertia]"), beam(1)); }), "");
  EXPECT_EQ(refusal([] { Scene(scene_of("linear", "[]"), beam(1)); }).substr(0, 15),
            "E_UNCONSTRAINED");
}

// How much energy a body of springs stores when it is stretched along many directions, by that of a
// solid of Young's modulus E and Poisson's ratio 1/4.
double spring_stiffness(const Body& body, double young) {
  const FiniteElements elements(body, 1);
  const SpringEnergy springs(elements, std::vector<double>(body.tets.size(), young));
  const std::vector<Lame> lame(body.tets.size(), Lame{0.4 * young, 0.4 * young});
  const ElasticEnergy solid(elements, lame, Constitution::kLinear);
  // The axes of an icosahedron: products of four of their coordinates have the means that all
  // directions have.
  const double golden = 0.5 * (1.0 + std::sqrt(5.0));
  double stored = 0.0, expected = 0.0;
  for (int k = 0; k < 6; ++k) {
    Vec3 n = Vec3::Zero();
    n[k / 2] = 1.0;
    n[(k / 2 + 1) % 3] = k % 2 == 0 ? golden : -golden;
    n.normalize();
    Eigen::VectorXd positions = rest_positions(elements);
    for (Eigen::Index i = 0; i < positions.size(); i += 3) {
      const Vec3 place = positions.segment<3>(i);
      positions.segment<3>(i) += 1e-4 * n * n.dot(place);
    }
    stored += springs.value(positions);
    expected += solid.value(positions);
  }
  return stored / expected;
}

TEST(Springs, HaveYoungsModulusOnAverage) {
  EXPECT_NEAR(spring_stiffness(*beam(4), 5e4), 1.0, 1e-3);
  EXPECT_NEAR(spring_stiffness(body_of(tissue_test::refined_ball(0.012)), 3e3), 1.0, 1e-3);
}

// Forces are minus the energy's derivative, and their derivatives are the matrix.
void expect_derivatives(const Energy& energy, const FiniteElements& elements,
                        const Eigen::VectorXd& positions, bool exact_hessian) {
  const Eigen::VectorXd gradient = energy.gradient(positions);
  AssembledHessian hessian(elements);
  energy.evaluate(positions, nullptr, &hessian);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 20; ++k) {
    Eigen::VectorXd way(positions.size());
    for (double& value : way) value = normal(random);
    const double step = 1e-7;
    const auto at = [&](double t) -> Eigen::VectorXd { return positions + t * way; };
    const double slope = (energy.value(at(step)) - energy.value(at(-step))) / (2.0 * step);
    EXPECT_NEAR(gradient.dot(way), slope, 1e-5 * gradient.norm() * way.norm());
    if (!exact_hessian) continue;
    const Eigen::VectorXd ahead = energy.gradient(at(step)), behind = energy.gradient(at(-step));
    Eigen::VectorXd product = Eigen::VectorXd::Zero(positions.size());
    hessian.matrix().multiply_add(way, product);
    EXPECT_LE((product - (ahead - behind) / (2.0 * step)).norm(), 1e-5 * product.norm());
  }
}

TEST(Dynamics, T11_SpringsInertiaAndDampingAreDerivativesOfTheirEnergy) {
  for (const int order : {1, 2}) {
    const auto body = beam(1);
    const FiniteElements elements(*body, order);
    const Eigen::VectorXd rest = rest_positions(elements);
    std::mt19937 random(9);
    std::normal_distribution<double> normal(0.0, 1e-3);
    Eigen::VectorXd positions = 1.2 * rest, velocities = rest;
    for (double& value : positions) value += normal(random);
    for (double& value : velocities) value = 10.0 * normal(random);
    InertiaEnergy inertia(elements, 1000.0);
    inertia.begin_step(rest, velocities, 0.01);
    expect_derivatives(inertia, elements, positions, true);
    const std::vector<Lame> lame(body->tets.size(), lame_of(1e4, 0.3));
    const ElasticEnergy elastic(elements, lame, Constitution::kNeoHookean);
    DampingEnergy damping(elastic, elements, inertia.mass(), 3.0, 0.01);
    damping.begin_step(rest, 0.01);
    expect_derivatives(damping, elements, positions, true);
    if (order == 2) continue;
    // Stretched springs have all of their stiffness.
    const SpringEnergy springs(elements, std::vector<double>(body->tets.size(), 1e4));
    expect_derivatives(springs, elements, positions, true);
    expect_derivatives(springs, elements, 0.8 * positions, false);
  }
}

}  // namespace
