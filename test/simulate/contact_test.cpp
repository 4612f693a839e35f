// Tools that press.
#include "support/bodies.h"
#include "support/known_solutions.h"
#include "support/mesh_checks.h"
#include "support/problem.h"
#include "tissue/base/error.h"
#include "tissue/simulate/closest_points.h"
#include "tissue/simulate/contact_energy.h"
#include "tissue/simulate/quadratic_system.h"
#include "tissue/simulate/scene_file.h"

#include <cmath>
#include <random>

namespace {

using namespace tissue;

struct Case {
  std::string model;
  int order = 1;
  std::string effects = {};

  std::string name() const { return model + " " + std::to_string(order) + effects; }
};

// All solids, at rest and with inertia.
std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const char* model : {"mass_spring", "linear", "corotational", "neo_hookean"}) {
    for (const int order : {1, 2}) {
      if (order == 2 && std::string(model) == "mass_spring") continue;
      for (const char* more : {"", ", inertia, damping"}) cases.push_back({model, order, more});
    }
  }
  return cases;
}

std::string scene_text(const Case& which, const std::string& tools, const std::string& more = "") {
  return "model: " + which.model + "\nelement_order: " + std::to_string(which.order) +
         "\nmaterial: {young: [[60, 3e3], [255, 60e3]], poisson: 0.45}\n"
         "anchors: [{plane: {axis: z, below: 20%}}]\n"
         "tools: " +
         tools + "\neffects: [density_response, contact" + which.effects + "]\n" + more;
}

const std::string kFinger = "[{name: finger, shape: {sphere: 0.006}, mode: press}]";
constexpr double kRadius = 0.006;

// A ball of 30 mm radius with a tumour of a third of that in it, in 2,000 tets of three levels.
std::shared_ptr<const Body> organ() {
  static const auto body = std::make_shared<Body>(body_of(tissue_test::refined_ball(0.024)));
  return body;
}

// A slab of 60 x 60 x 20 mm.
std::shared_ptr<const Body> slab(int cells = 12) {
  return std::make_shared<Body>(
      tissue_test::kuhn_block({cells, cells, cells / 3}, {0.06, 0.06, 0.02}));
}

// The ball's tip is so far above the organ's north pole, beside it by a little.
ToolPose above(double height, double radius = kRadius) {
  return {Vec3(0.0013, 0.0007, 0.030 + radius + height)};
}

double farthest_from_rest(const Scene& scene) {
  double farthest = 0.0;
  for (std::size_t v = 0; v < scene.body().rest.size(); ++v) {
    const Vec3 rest = scene.body().rest[v].cast<double>();
    farthest = std::max(farthest, (scene.state().positions[v] - rest).norm());
  }
  return farthest;
}

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

TEST(Contact, AToolThatJumpsIsCaughtByItsPath) {
  for (const Case& which : all_cases()) {
    if (which.order == 2) continue;
    const std::string text = scene_text({which.model}, kFinger, "solver: {tolerance: 1e-6}\n");
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
    for (double height = 0.004; height > -0.09; height -= 0.004) {
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

TEST(ClosestPoints, OfTrianglesAndSegmentsAreNoFartherThanAnyOther) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  const auto place = [&] {
    return Vec3(coordinate(random), coordinate(random), coordinate(random));
  };
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = place(), a = place(), b = place(), c = i % 7 == 0 ? Vec3(2.0 * b - a) : place();
    const std::array<double, 3> w = closest_in_triangle(p, a, b, c);
    EXPECT_NEAR(w[0] + w[1] + w[2], 1.0, 1e-12);
    EXPECT_GE(std::min({w[0], w[1], w[2]}), 0.0);
    const double distance = (p - w[0] * a - w[1] * b - w[2] * c).norm();
    const AlongSegments along = closest_of_segments(p, a, b, c);
    const double apart = (p + along.first * (a - p) - b - along.second * (c - b)).norm();
    for (int k = 0; k < 20; ++k) {
      const double u = std::abs(coordinate(random)), v = std::abs(coordinate(random)) * (1.0 - u);
      EXPECT_LE(distance, (p - (1.0 - u - v) * a - u * b - v * c).norm() + 1e-12);
      const double t = std::abs(coordinate(random));
      EXPECT_LE(apart, (p + u * (a - p) - b - t * (c - b)).norm() + 1e-9);
    }
  }
}

TEST(NodeSurface, KnowsInsideFromOutside) {
  const auto body = organ();
  const FiniteElements elements(*body, 2);
  const NodeSurface surface(elements, *body);
  const Eigen::VectorXd rest = rest_positions(elements);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-0.04, 0.04);
  for (int i = 0; i < 500; ++i) {
    const Vec3 place(coordinate(random), coordinate(random), coordinate(random));
    const double r = place.norm();
    if (r > 0.026 && r < 0.0305) continue;
    EXPECT_EQ(surface.contains(place, rest), r < 0.03) << place.transpose();
    const double away = surface.distance({place, place, 0.0}, rest, 1.0);
    EXPECT_NEAR(away, std::abs(r - 0.03), 0.004);
  }
  // Through vertices and edges.
  for (const Vec3f& vertex : body->rest) {
    if (vertex.norm() > 0.02f) continue;
    EXPECT_TRUE(surface.contains(vertex.cast<double>(), rest));
    EXPECT_FALSE(surface.contains(vertex.cast<double>() - Vec3(0.1, 0.0, 0.0), rest));
  }
}

}  // namespace
