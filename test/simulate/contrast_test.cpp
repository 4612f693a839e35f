// What has to hold of every model on uniform and on density-refined meshes, whatever the contrast.
#include "support/bodies.h"
#include "support/figures.h"
#include "support/mesh_checks.h"
#include "support/problem.h"
#include "support/subjects.h"
#include "tissue/refine/refine.h"
#include "tissue/simulate/scene_file.h"

#include <random>

namespace {

using namespace tissue;
using tissue_test::for_each_tissue;
using tissue_test::nodes_where;
using tissue_test::Problem;
using tissue_test::refusal;
using tissue_test::Subject;
using tissue_test::Tissue;
using tissue_test::top_of;

const char* const kModels[] = {"mass_spring", "linear", "corotational", "neo_hookean"};
const Constitution kConstitutions[] = {Constitution::kLinear, Constitution::kCorotational,
                                       Constitution::kNeoHookean};

// A scene whose tool grips what is on top.
SceneDescription scene_of(const std::string& model, const Subject& subject, const Tissue& tissue,
                          const std::string& effects, const std::string& more = "") {
  return parse_scene("model: " + model + "\n" + tissue.scene(subject) +
                     "tools: [{name: tool, shape: {sphere: " + std::to_string(0.3 * subject.size) +
                     "}, mode: grasp}]\n"
                     "effects: " +
                     effects + "\n" + more);
}
// Finite, and a tet that is inside out is never kept quiet. Springs know no inside and outside.
void expect_sound(const Scene& scene, const StepReport& report) {
  for (const Vec3& place : scene.state().positions) ASSERT_TRUE(place.allFinite());
  EXPECT_EQ(report.folded, deformation_quality(scene.body(), scene.state()).inverted > 0);
}

// Pulled far, with tissue that hardly changes its volume: where no equilibrium is found the tissue
// stays on its way to one.
TEST(Contrast, S2_APullEndsInEquilibriumOrSaysNotConverged) {
  std::size_t steps = 0, without = 0;
  const auto pull = [&](const Subject& subject, const Tissue& tissue) {
    for (const char* model : kModels) {
      SCOPED_TRACE(model);
      Scene scene(
          scene_of(model, subject, tissue, "[density_response]", "solver: {max_iterations: 30}\n"),
          subject.body);
      const Vec3 top = top_of(subject);
      scene.step(ToolPose{top, true}, 0.01);
      for (const double far : {0.1, 0.6}) {
        const Vec3 place = top + far * subject.size * Vec3(0.4, 0.0, 0.8);
        const StepReport report = scene.step(ToolPose{place, true}, 0.01);
        expect_sound(scene, report);
        ++steps;
        without += report.not_converged;
      }
    }
  };
  for_each_tissue({0.45, 0.4999}, pull);
  const Subject sliver = tissue_test::block_with_a_sliver();
  for (const double contrast : tissue_test::kContrasts) pull(sliver, {contrast, 0.4999});
  tissue_test::figure("steps that said NOT_CONVERGED, of " + std::to_string(steps),
                      static_cast<double>(without));
  EXPECT_LT(without, steps / 2);
}

// Jerked by more than a tet's size and let go, in steps short and long.
void jerk(const std::string& model, const Subject& subject, const Tissue& tissue, double dt) {
  SCOPED_TRACE(model + ", steps of " + std::to_string(dt) + " s");
  Scene scene(scene_of(model, subject, tissue, "[density_response, inertia, damping]"),
              subject.body);
  const Vec3 top = top_of(subject);
  scene.step(ToolPose{top, true}, dt);
  for (int i = 1; i <= 2; ++i) {
    scene.step(ToolPose{top + i * subject.size * Vec3(0.07, 0.0, 0.13), true}, dt);
  }
  double energy = *scene.step(ToolPose{top, false}, dt).energy;
  for (int i = 0; i < 4; ++i) {
    const StepReport report = scene.step(ToolPose{top, false}, dt);
    expect_sound(scene, report);
    EXPECT_FALSE(report.not_converged);
    // One linearised step is not yet iterated to convergence.
    EXPECT_LE(*report.energy, 1.01 * energy + 1e-12);
    energy = *report.energy;
  }
}

TEST(Contrast, S2_S3_T8_JerkedTissueStaysFiniteAndLosesEnergyInShortAndLongSteps) {
  for_each_tissue({0.45}, [](const Subject& subject, const Tissue& tissue) {
    for (const char* model : kModels) {
      for (const double dt : {1e-3, 1e-1}) jerk(model, subject, tissue, dt);
      // Ten seconds are hundreds of substeps.
      if (tissue.contrast == 1e4) jerk(model, subject, tissue, 10.0);
    }
  });
}

TEST(Contrast, S3_S7_TimesThatAreNoneAreRefusedAndOverflowsLeaveTheLastState) {
  for_each_tissue({0.45}, [](const Subject& subject, const Tissue& tissue) {
    for (const char* model : kModels) {
      SCOPED_TRACE(model);
      Scene scene(scene_of(model, subject, tissue, "[density_response, inertia, damping]"),
                  subject.body);
      const Vec3 top = top_of(subject);
      scene.step(ToolPose{top, true}, 0.01);
      scene.step(ToolPose{top + Vec3(0.0, 0.002, 0.0), true}, 0.01);
      const std::vector<Vec3> before = scene.state().positions;
      for (const double dt : {-0.01, std::nan(""), HUGE_VAL}) {
        EXPECT_EQ(refusal([&] { scene.step(ToolPose{top, true}, dt); }).substr(0, 5), "E_DT:");
      }
      // Masses over squares of such a time are no numbers.
      EXPECT_TRUE(scene.step(ToolPose{top, true}, 1e-200).not_converged);
      EXPECT_EQ(scene.state().positions, before);
      const StepReport report = scene.step(ToolPose{top, true}, 0.01);
      EXPECT_FALSE(report.not_converged);
      expect_sound(scene, report);
    }
  });
}

// Contrast makes pivots small too; only what nothing holds is refused for them.
TEST(Contrast, S4_S5_T14_OnlyWhatNothingHoldsIsRefused) {
  for_each_tissue({0.45, 0.4999}, [](const Subject& subject, const Tissue& tissue) {
    Problem problem(*subject.body, 1, Constitution::kLinear, tissue.material());
    const auto system = direct_system(problem.elements);
    problem.energy.evaluate(problem.positions, nullptr, system.get());
    std::vector<std::uint8_t> held(3 * problem.elements.node_count(), 0);
    EXPECT_FALSE(system->prepare(held, 0.0));
    // Two nodes are a hinge.
    std::fill_n(held.begin(), 6, std::uint8_t{1});
    EXPECT_FALSE(system->prepare(held, 0.0));
    for (std::size_t node = 0; node < problem.elements.node_count(); ++node) {
      const bool is_held = problem.elements.rest()[node].z() < subject.held_below;
      std::fill_n(held.begin() + static_cast<std::ptrdiff_t>(3 * node), 3, is_held);
    }
    EXPECT_TRUE(system->prepare(held, 0.0));

    for (const char* model : kModels) {
      SceneDescription scene = scene_of(model, subject, tissue, "[density_response]");
      EXPECT_EQ(refusal([&] { Scene(scene, subject.body); }), "") << model;
      scene.anchors.clear();
      EXPECT_EQ(refusal([&] { Scene(scene, subject.body); }).substr(0, 16), "E_UNCONSTRAINED:")
          << model;
      // A body that flies is well-posed.
      scene = scene_of(model, subject, tissue, "[density_response, inertia]");
      scene.anchors.clear();
      EXPECT_EQ(refusal([&] { Scene(scene, subject.body); }), "") << model;
    }
  });
}

TEST(Contrast, T10_RigidMotionMakesNoForce) {
  for_each_tissue({0.45}, [](const Subject& subject, const Tissue& tissue) {
    for (const Constitution constitution :
         {Constitution::kCorotational, Constitution::kNeoHookean}) {
      Problem problem(*subject.body, 1, constitution, tissue.material());
      for (double degrees = 0.0; degrees <= 720.0; degrees += 45.0) {
        const Mat3 rotation = Eigen::AngleAxisd(degrees * M_PI / 180.0, Vec3(1, 2, 3).normalized())
                                  .toRotationMatrix();
        for (std::size_t node = 0; node < problem.elements.node_count(); ++node) {
          problem.positions.segment<3>(static_cast<Eigen::Index>(3 * node)) =
              rotation * problem.elements.rest()[node] + Vec3(6, -8, 0);
        }
        const double stiffest = 1e4 * tissue.contrast * subject.size * subject.size;
        const double force = problem.energy.gradient(problem.positions).norm() / stiffest;
        EXPECT_LE(force, 1e-9);
        tissue_test::figure("force of a rigid motion, by E L^2", force);
      }
    }
  });
}

// Along random directions, for the whole matrix of a mesh is too much to difference.
TEST(Contrast, T11_ForcesAndStiffnessAreDerivativesOfEnergy) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for_each_tissue({0.45}, [&](const Subject& subject, const Tissue& tissue) {
    for (const Constitution constitution : kConstitutions) {
      Problem problem(*subject.body, 1, constitution, tissue.material());
      const auto direction = [&] {
        return Eigen::VectorXd(
            Eigen::VectorXd::NullaryExpr(problem.positions.size(), [&] { return normal(random); }));
      };
      // So near to rest that little had to be made convex.
      problem.positions += 1e-8 * direction();
      AssembledHessian hessian(problem.elements);
      problem.energy.evaluate(problem.positions, nullptr, &hessian);
      const Eigen::VectorXd u = direction();
      const double h = 1e-7;
      const Eigen::VectorXd more = problem.positions + h * u, less = problem.positions - h * u;
      const Eigen::VectorXd forces_more = problem.energy.gradient(more),
                            forces_less = problem.energy.gradient(less);
      const double power = 0.5 * (forces_more + forces_less).dot(u);
      EXPECT_NEAR((problem.energy.value(more) - problem.energy.value(less)) / (2.0 * h), power,
                  1e-5 * forces_more.norm() * u.norm());
      Eigen::VectorXd product = Eigen::VectorXd::Zero(u.size());
      hessian.matrix().multiply_add(u, product);
      const Eigen::VectorXd difference = (forces_more - forces_less) / (2.0 * h);
      EXPECT_LE((product - difference).norm(), 1e-4 * difference.norm());
    }
  });
}

// A bar in layers of 20 mm, every second one finer than the others where it is `graded`.
Body layered_bar(bool graded) {
  Body body = tissue_test::kuhn_block({8, 2, 2}, {0.08, 0.02, 0.02});
  const auto is_hard = [](const Body& of, std::size_t t) {
    return std::fmod(tissue_test::centroid(of, t).x(), 0.04) > 0.02;
  };
  if (graded) {
    LatticeMesh lattice;
    for (const Vec3f& place : body.rest) lattice.vertices.push_back(place.cast<double>());
    lattice.tets = body.tets;
    lattice.whole.assign(body.tets.size(), 0);
    lattice.surface = body.surface;
    std::vector<std::uint8_t> levels;
    for (std::size_t t = 0; t < body.tets.size(); ++t) levels.push_back(is_hard(body, t) ? 0 : 1);
    const RefinedMesh refined = refine(refinable(std::move(lattice)), levels, 1u << 20);
    EXPECT_LT(refined.tets.size(), 8 * body.tets.size());
    EXPECT_GT(refined.tets.size(), 4 * body.tets.size());
    body.rest = refined.vertices;
    body.tets = refined.tets;
    body.surface = refined.surface;
  }
  body.tet_densities.resize(body.tets.size());
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    body.tet_densities[t] = is_hard(body, t) ? 2.0f : 1.0f;
  }
  return body;
}

// Pulled along its length with its sides sliding: strains are in inverse proportion to stiffness,
// exactly.
TEST(Contrast, T12_ALayeredBarIsExactWhereLayersMeetAtFaces) {
  for (const bool graded : {false, true}) {
    for (const int order : {1, 2}) {
      for (const double contrast : tissue_test::kContrasts) {
        SCOPED_TRACE(contrast);
        // Without lateral strain coupling (ν = 0) the series is one-dimensional.
        Problem problem(layered_bar(graded), order, Constitution::kLinear,
                        Tissue{contrast, 0.0}.material());
        const std::vector<Vec3>& rest = problem.elements.rest();
        const auto held =
            nodes_where(rest, [](const Vec3& p) { return p.x() < 1e-7 || p.x() > 0.08 - 1e-7; });
        const double pulled = 1e-3, soft = pulled / 0.04 / (1.0 + 1.0 / contrast),
                     hard = soft / contrast;
        const auto expected = [&](double x) {
          const double period = std::floor(x / 0.04 + 1e-6), within = x - 0.04 * period;
          return period * 0.02 * (soft + hard) + std::min(within, 0.02) * soft +
                 std::max(0.0, within - 0.02) * hard;
        };
        for (std::size_t node = 0; node < rest.size(); ++node) {
          if (held[node] != 0) problem.move(node, Vec3(expected(rest[node].x()), 0, 0));
        }
        EXPECT_TRUE(problem.solve(held, nullptr, 1e-12).converged);
        double error = 0.0;
        for (std::size_t node = 0; node < rest.size(); ++node) {
          error = std::max(
              error, std::abs(problem.displacement(node).x() - expected(rest[node].x())) / 0.08);
        }
        // Places are stored as floats.
        EXPECT_LE(error, 1e-8);
        tissue_test::figure("error of a layered bar, by its length", error);
      }
    }
  }
}

}  // namespace
