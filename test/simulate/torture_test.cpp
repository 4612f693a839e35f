// Shapes that no tissue ever has, contrasts and ratios that no solver likes.
#include "support/bodies.h"
#include "support/figures.h"
#include "support/problem.h"
#include "support/subjects.h"
#include "tissue/simulate/scene_file.h"

#include <random>

namespace {

using namespace tissue;
using tissue_test::for_each_tissue;
using tissue_test::nodes_where;
using tissue_test::Problem;
using tissue_test::Subject;
using tissue_test::Tissue;

// How a body that was thrown into some shape came to rest.
struct Recovery {
  EquilibriumReport report;
  bool finite = false, energy_fell = false;
  std::size_t inverted = 0;
  // Largest distance from rest, by the body's size.
  double error = 0.0;
};

Recovery recover(const Subject& subject, const Tissue& tissue,
                 const std::function<Vec3(const Vec3&)>& thrown, int iterations = 100) {
  Problem problem(*subject.body, 1, Constitution::kNeoHookean, tissue.material());
  const std::vector<Vec3>& rest = problem.elements.rest();
  const auto held = nodes_where(rest, [&](const Vec3& p) { return p.z() < subject.held_below; });
  for (std::size_t node = 0; node < rest.size(); ++node) {
    if (held[node] == 0) problem.move(node, thrown(rest[node]) - rest[node]);
  }
  Equilibrium equilibrium({&problem.energy}, direct_system(problem.elements));
  equilibrium.hold(held);
  // From step to step the energy never rises.
  Recovery result;
  double energy = equilibrium.energy(problem.positions);
  const double rounding = 1e-9 * energy;
  result.energy_fell = true;
  for (int done = 0; done < iterations && !result.report.converged; done += 20) {
    result.report = equilibrium.solve(problem.positions, {1e-9, 20});
    result.energy_fell = result.energy_fell && result.report.energy <= energy + rounding;
    energy = result.report.energy;
  }
  result.finite = problem.positions.allFinite();
  State state = rest_state(problem.body);
  for (std::size_t v = 0; v < state.positions.size(); ++v) {
    state.positions[v] += problem.displacement(v);
    result.error = std::max(result.error, problem.displacement(v).norm() / subject.size);
  }
  result.inverted = deformation_quality(problem.body, state).inverted;
  return result;
}

constexpr auto kPoissons = {0.3, 0.45, 0.49};
constexpr double kAnywhere = 1e9;

// Back at rest within `error`, or anywhere: finite and lower in energy in any case.
void expect_rest(const Recovery& found, double error) {
  EXPECT_TRUE(found.finite);
  EXPECT_TRUE(found.energy_fell);
  EXPECT_LE(found.error, error);
  if (error < kAnywhere) {
    tissue_test::figure("farthest from rest, by the size", found.error);
    EXPECT_EQ(found.inverted, 0u);
  }
}

TEST(Torture, T4_AFlattenedBodyComesBackAtAnyContrast) {
  for_each_tissue(kPoissons, [](const Subject& subject, const Tissue& tissue) {
    const auto flattened = [&](const Vec3& p) { return Vec3(p.x(), p.y(), subject.held_below); };
    expect_rest(recover(subject, tissue, flattened), 1e-4);
  });
}

// With contrast, or near incompressibility, rounding decides which equilibrium it comes to, and
// nobody promises otherwise.
TEST(Torture, T5_ABodyCollapsedToAPointStaysFiniteAndComesBackWhereItIsUniform) {
  for_each_tissue(kPoissons, [](const Subject& subject, const Tissue& tissue) {
    expect_rest(
        recover(subject, tissue, [&](const Vec3&) { return Vec3(0.01, 0.01, subject.held_below); }),
        tissue.contrast == 1.0 && tissue.poisson <= 0.45 ? 1e-6 : kAnywhere);
  });
}

TEST(Torture, T6_ABodyTurnedInsideOutStaysFiniteAndComesBackWithoutContrast) {
  for_each_tissue(kPoissons, [](const Subject& subject, const Tissue& tissue) {
    const auto reflected = [&](const Vec3& p) {
      return Vec3(p.x(), p.y(), 2.0 * subject.held_below - p.z());
    };
    expect_rest(recover(subject, tissue, reflected), tissue.contrast == 1.0 ? 1e-5 : kAnywhere);
  });
}

// Back to rest it may not come, and nobody promises it: reset() is for that.
TEST(Torture, T7_AScrambledBodyStaysFiniteAndItsEnergyFalls) {
  for_each_tissue(kPoissons, [](const Subject& subject, const Tissue& tissue) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> within(0.0, subject.size);
    const auto scrambled = [&](const Vec3&) {
      return Vec3(within(random), within(random), within(random));
    };
    expect_rest(recover(subject, tissue, scrambled, 20), kAnywhere);
  });
}

// A stiff layer in a soft block, sheared: whatever the contrast and Poisson's ratio, what the
// factorisation answers balances the forces.
TEST(Torture, T13_LinearSolvesHoldTheirResidual) {
  for (const auto& make_system : {direct_system, eigen_system}) {
    for_each_tissue({0.45, 0.49, 0.4999}, [&](const Subject& subject, const Tissue& tissue) {
      Problem problem(*subject.body, 1, Constitution::kLinear, tissue.material());
      const std::vector<Vec3>& rest = problem.elements.rest();
      auto held = nodes_where(rest, [&](const Vec3& p) { return p.z() < subject.held_below; });
      for (std::size_t node = 0; node < rest.size(); ++node) {
        if (rest[node].z() < 0.8 * subject.top) continue;
        held[node] = 1;
        problem.move(node, Vec3(0.002, 0.0, 0.001));
      }
      Equilibrium equilibrium({&problem.energy}, make_system(problem.elements), {}, true);
      equilibrium.hold(held);
      const EquilibriumReport report = equilibrium.solve(problem.positions, {1e-6, 5});
      EXPECT_TRUE(report.converged) << report.residual;
      EXPECT_LE(report.residual, 1e-6);
      tissue_test::figure("residual", report.residual);
    });
  }
}

// Pressed together by a tenth between plates that do not let it slip: the force, and the part of
// the volume that is lost.
struct Pressed {
  double force, volume_lost;
};
Pressed pressed(const Subject& subject, const Tissue& tissue, int order,
                const std::string& effect = "") {
  Scene scene(parse_scene("model: neo_hookean\nelement_order: " + std::to_string(order) + "\n" +
                          tissue.scene(subject) +
                          "tools: [{name: plate, shape: {sphere: 0.9}, mode: grasp}]\n"
                          "effects: [density_response" +
                          effect + "]\n"),
              subject.body);
  // So large a sphere holds what is on top, and nothing below.
  const Vec3 above = tissue_test::top_of(subject) + Vec3(0.0, 0.0, 0.9 - 0.03 * subject.size);
  EXPECT_FALSE(scene.step(ToolPose{above}, 0.0).not_converged);
  const StepReport report = scene.step(ToolPose{above - Vec3(0.0, 0.0, 0.1 * subject.size)}, 0.0);
  EXPECT_FALSE(report.not_converged) << report.residual;
  Pressed result = {scene.tool_forces()[0]->z(), 0.0};
  const std::vector<TetStrain> strains = scene.strains();
  for (const TetStrain& strain : strains) {
    result.volume_lost += (1.0 - strain.det_f) / static_cast<double>(strains.size());
  }
  return result;
}

// Without a tumour, in cubes of six tets.
Subject even_block(int cells) {
  return {"even block",
          std::make_shared<const Body>(
              tissue_test::kuhn_block({cells, cells, cells}, Vec3::Constant(0.04))),
          0.04, 0.04, 1e-7};
}

// Linear tets lock where tissue keeps its volume; what that costs is stated, not hidden, and so is
// what the effect leaves of it.
TEST(Torture, T17_LinearTetsLockAndTheirExcessIsMeasured) {
  for (const double poisson : {0.49, 0.4999}) {
    const Subject coarse = even_block(3), fine = even_block(6);
    const Tissue even = {1.0, poisson};
    const Pressed finer = pressed(fine, even, 2), quadratic = pressed(coarse, even, 2),
                  linear = pressed(fine, even, 1),
                  averaged = pressed(fine, even, 1, ", near_incompressibility");
    std::printf(
        "Poisson's ratio %g: linear tets %.2f times as stiff as quadratic ones, with "
        "near_incompressibility %.2f times, quadratic ones with as many nodes %.2f times; volume "
        "lost %.2g, %.2g and %.2g\n",
        poisson, linear.force / finer.force, averaged.force / finer.force,
        quadratic.force / finer.force, linear.volume_lost, averaged.volume_lost,
        quadratic.volume_lost);
    const std::string at = " at " + std::to_string(poisson);
    tissue_test::figure("force of linear tets, by the right one," + at, linear.force / finer.force);
    tissue_test::figure("with near_incompressibility" + at, averaged.force / finer.force);
    EXPECT_GT(linear.force, 1.2 * finer.force);
    EXPECT_NEAR(quadratic.force, finer.force, 0.1 * finer.force);
    EXPECT_NEAR(averaged.force, finer.force, 0.2 * finer.force);
    // Of a tenth that it was pressed together, hardly anything is lost in volume.
    for (const Pressed& one : {finer, quadratic, linear, averaged}) {
      EXPECT_LT(std::abs(one.volume_lost), 0.01);
    }
  }
}

// Against quadratic tets on the same mesh.
TEST(Torture, T17_LinearTetsLockOnRefinedMeshesWithATumourToo) {
  const Subject& ball = tissue_test::subjects()[1];
  for (const double contrast : tissue_test::kContrasts) {
    const Tissue tissue = {contrast, 0.4999};
    const Pressed linear = pressed(ball, tissue, 1), quadratic = pressed(ball, tissue, 2);
    tissue_test::figure("on a refined ball at contrast " + std::to_string(std::lround(contrast)),
                        linear.force / quadratic.force);
    EXPECT_GT(linear.force, quadratic.force);
    EXPECT_LT(std::abs(quadratic.volume_lost), 0.01);
  }
}

}  // namespace
