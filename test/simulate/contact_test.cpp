// Tools that press.
#include "support/bodies.h"
#include "support/mesh_checks.h"
#include "support/pressing_scenes.h"
#include "support/problem.h"
#include "tissue/simulate/contact_energy.h"
#include "tissue/simulate/quadratic_system.h"
#include "tissue/simulate/scene_file.h"

#include <cmath>

namespace {

using namespace tissue;
using namespace tissue_test;

// A quarter of a half space under a ball, its far sides moved as Boussinesq has them (Johnson,
// Contact Mechanics, 3.19): force by Hertz's.
double force_by_hertz(int order, int cells) {
  constexpr double kYoung = 5e3, kPoisson = 0.3, kBall = 0.04, kDepth = 1e-3;
  const double patch = std::sqrt(kBall * kDepth), size = 10.0 * patch;
  const double force =
      4.0 / 3.0 * kYoung / (1.0 - kPoisson * kPoisson) * std::sqrt(kBall) * std::pow(kDepth, 1.5);
  Body body = tissue_test::kuhn_block({cells, cells, cells}, {1.0, 1.0, 1.0});
  for (Vec3f& place : body.rest) {
    // Fine where the ball is.
    place = {place.x() * place.x(), place.y() * place.y(),
             -(1.0f - place.z()) * (1.0f - place.z())};
    place *= static_cast<float>(size);
  }
  tissue_test::Problem problem(body, order, Constitution::kLinear,
                               {{{0.0, kYoung}}, kPoisson, 1000.0});
  const std::vector<Vec3>& rest = problem.elements.rest();
  std::vector<std::uint8_t> held(3 * rest.size(), 0);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Vec3& p = rest[i];
    held[3 * i] = p.x() < 1e-9;
    held[3 * i + 1] = p.y() < 1e-9;
    if (p.cwiseAbs().maxCoeff() < 0.9999 * size) continue;
    std::fill_n(held.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, 1);
    const double z = -p.z(), far = p.norm();
    const double unit = force * (1.0 + kPoisson) / (2.0 * M_PI * kYoung * far);
    const double aside = unit * (z / (far * far) - (1.0 - 2.0 * kPoisson) / (far + z));
    const double down = unit * (2.0 * (1.0 - kPoisson) + z * z / (far * far));
    problem.move(i, Vec3(aside * p.x(), aside * p.y(), -down));
  }
  ContactEnergy contact(problem.elements, body, std::vector<double>(body.tets.size(), kYoung),
                        {kBall});
  const Vec3 centre(0.0, 0.0, kBall - kDepth);
  contact.place(0, Capsule{centre, centre, kBall});
  contact.find_pairs(problem.positions, 1.0);
  Equilibrium equilibrium({&problem.energy, &contact},
                          order == 2
                              ? quadratic_system(problem.elements, Constitution::kLinear, 1e-3)
                              : direct_system(problem.elements));
  equilibrium.hold_coordinates(held);
  EXPECT_TRUE(equilibrium.solve(problem.positions, {1e-6, 100}).converged);
  double sum = 0.0;
  contact.for_each_touch(0, problem.positions, centre,
                         [&](const Vec3&, const Vec3& one) { sum += one.z(); });
  return 4.0 * sum / force;
}

TEST(Contact, AnswersABallAsHertzSays) {
  const double coarse = force_by_hertz(2, 4), fine = force_by_hertz(2, 8);
  std::printf("force by Hertz's, quadratic tets: %.3f at 4 cells, %.3f at 8\n", coarse, fine);
  EXPECT_LE(std::abs(fine - 1.0), 0.05);
  EXPECT_LT(std::abs(fine - 1.0), 0.5 * std::abs(coarse - 1.0)) << coarse << " " << fine;
  const double coarse_linear = force_by_hertz(1, 6), fine_linear = force_by_hertz(1, 12);
  EXPECT_LT(std::abs(fine_linear - 1.0), 0.5 * std::abs(coarse_linear - 1.0))
      << coarse_linear << " " << fine_linear;
}

TEST(Contact, NoToolIsDeeperInTheSurfaceThanAHundredthOfItsRadiusAndTheTissueComesBack) {
  for (const Case& which : all_cases()) {
    for (const char* tools :
         {"[{name: a, shape: {sphere: 0.006}, mode: press}]",
          "[{name: a, shape: {capsule: {radius: 0.006, length: 0.1}}, mode: press}]"}) {
      Scene scene(parse_scene(scene_text(which, tools)), organ());
      for (const double height : {0.004, -0.001, -0.004, -0.006, -0.003}) {
        ToolPose pose = above(height);
        // A shaft that comes down from above, aslant.
        pose.orientation = Eigen::AngleAxisd(M_PI + 0.3, Vec3::UnitX());
        const StepReport report = scene.step(pose, 0.02);
        EXPECT_FALSE(report.not_converged || report.clamped) << which.name() << " " << height;
        EXPECT_LE(report.penetration, 0.01 * kRadius) << which.name() << " " << height;
        // The surface is where it has to be, by vertices.
        for (const Vec3& place : scene.state().positions) {
          EXPECT_GE((place - pose.position).norm(), 0.99 * kRadius) << which.name();
        }
        EXPECT_EQ(scene.tool_forces()[0]->z() > 0.0, height < 0.0) << which.name() << height;
        EXPECT_EQ(farthest_from_rest(scene) > 1e-4, height < 0.0) << which.name() << height;
      }
      if (!which.effects.empty()) continue;
      // Drawn back, and lost.
      const auto upright = [](double height) {
        ToolPose pose = above(height);
        pose.orientation = Eigen::AngleAxisd(M_PI, Vec3::UnitX());
        return pose;
      };
      scene.step(upright(-0.006), 0.02);
      scene.step(upright(0.010), 0.02);
      EXPECT_LE(farthest_from_rest(scene), 1e-4) << which.name();
      scene.step(upright(-0.006), 0.02);
      EXPECT_TRUE(scene.step(std::nullopt, 0.02).tool_lost);
      EXPECT_LE(farthest_from_rest(scene), 1e-4) << which.name();
      EXPECT_EQ(scene.tool_forces()[0]->norm(), 0.0);
    }
  }
}

// Farthest lateral force, by the normal one, while a finger slides over a slab.
TEST(Contact, SlidesWithoutSticking) {
  for (const Case& which : {Case{"linear"}, Case{"corotational"}, Case{"neo_hookean", 2}}) {
    const auto body = slab(which.order == 1 ? 18 : 9);
    Scene scene(parse_scene(scene_text(which, kFinger, "solver: {tolerance: 1e-6}\n")), body);
    const auto at = [](double x) { return ToolPose{Vec3(x, 0.0313, 0.020 + kRadius - 0.002)}; };
    scene.step(at(0.020), 0.01);
    for (double x = 0.024; x < 0.0401; x += 0.004) {
      EXPECT_FALSE(scene.step(at(x), 0.01).not_converged);
      const Vec3 force = *scene.tool_forces()[0];
      EXPECT_GT(force.z(), 0.0);
      EXPECT_LE(force.head<2>().norm(), 0.15 * force.z()) << which.name() << " " << x;
    }
    // Where it was, nothing is left of it; where it is, the same as there.
    Scene other(scene.description(), body);
    other.step(at(0.040), 0.01);
    double farthest = 0.0;
    for (std::size_t v = 0; v < body->rest.size(); ++v) {
      farthest =
          std::max(farthest, (scene.state().positions[v] - other.state().positions[v]).norm());
    }
    EXPECT_LE(farthest, 2e-5) << which.name();
  }
}

TEST(Contact, TheSameBitsWithOneThreadAndTwo) {
  for (const Case& which : all_cases()) {
    std::vector<std::vector<Vec3>> results;
    for (const int threads : {1, 2}) {
      Scene scene(parse_scene(scene_text(which, kFinger)), organ(), threads);
      scene.step(above(0.001), 0.01);
      scene.step(above(-0.004), 0.01);
      results.push_back(scene.state().positions);
    }
    EXPECT_EQ(results[0], results[1]) << which.name();
  }
}

TEST(Contact, ScenesSayWhatPresses) {
  using tissue_test::refusal;
  const auto refused = [](const std::string& tools, const std::string& effects) {
    return refusal(
        [&] { parse_scene("model: linear\ntools: " + tools + "\neffects: " + effects + "\n"); });
  };
  EXPECT_NE(refused("[{name: a, mode: grasp}]", "[contact]").find("without a tool of mode press"),
            std::string::npos);
  EXPECT_NE(refused("[{name: a, shape: {pad: {radius: 0.01}}, mode: press}]", "[contact]")
                .find("is a sphere or a capsule, not a pad"),
            std::string::npos);
  EXPECT_NE(refused("[{name: a, shape: {capsule: {radius: 0.01, length: 0.1}}, mode: grasp}]", "[]")
                .find("is a sphere or a pad, not a capsule"),
            std::string::npos);
  EXPECT_NE(refused("[{name: a, mode: press}]", "[{contact: {tolerance: 0}}]").find("tolerance"),
            std::string::npos);
  const SceneDescription scene = parse_scene(
      "model: linear\ntools: [{name: a, shape: {capsule: {radius: 0.01, length: 0.1}}}]\n"
      "effects: [contact]\n");
  EXPECT_EQ(scene.tools[0].length, 0.1);
}

}  // namespace
