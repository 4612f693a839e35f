// Tissue that keeps its volume.
#include "support/bodies.h"
#include "support/mesh_checks.h"
#include "support/problem.h"
#include "tissue/base/tet_mesh.h"
#include "tissue/simulate/averaged_volume.h"
#include "tissue/simulate/hessian_product.h"
#include "tissue/simulate/multigrid_system.h"
#include "tissue/simulate/scene_file.h"
#include "tissue/simulate/squared_system.h"

#include <random>

namespace {

using namespace tissue;

const char* const kModels[] = {"linear", "corotational", "neo_hookean"};

std::shared_ptr<const Body> beam(int cells) {
  return std::make_shared<Body>(
      tissue_test::kuhn_block({2 * cells, cells, cells}, {0.2, 0.1, 0.1}, 1));
}

// By how much a body is larger than at rest, as a part of its volume: of its elements as they are
// curved.
double swelling(const Scene& scene) {
  const Body& body = scene.body();
  const std::vector<TetStrain> strains = scene.strains();
  double rest = 0.0, more = 0.0;
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    const Tet& tet = body.tets[t];
    const double six = determinant(body.rest, tet);
    rest += six;
    more += six * (strains[t].det_f - 1.0);
  }
  return more / rest;
}

// How far a clamped beam sags under its weight [m].
double sag(const std::string& model, int order, int cells, double poisson, bool averages) {
  Scene scene(parse_scene("model: " + model + "\nelement_order: " + std::to_string(order) +
                          "\nmaterial: {young: [[0, 50e3]], poisson: " + std::to_string(poisson) +
                          "}\nanchors: [{plane: {axis: x, below: 0.001}}]\n"
                          "probes: {end: [0.2, 0.05, 0.05]}\neffects: [gravity" +
                          (averages ? ", near_incompressibility" : "") + "]\n"),
              beam(cells));
  EXPECT_FALSE(scene.step(ToolPoses{}, 0.0).not_converged) << model << order;
  return 0.05 - scene.probes().at("end")->z();
}

TEST(NearIncompressibility, ForcesAndStiffnessAreDerivativesOfTheEnergy) {
  std::mt19937 generator(2);
  for (const int order : {1, 2}) {
    for (const auto constitution : {Constitution::kLinear, Constitution::kNeoHookean}) {
      const Body body = tissue_test::kuhn_block({2, 1, 1}, {0.04, 0.02, 0.02});
      const FiniteElements elements(body, order);
      // Two kinds of tissue.
      std::vector<double> lambda(elements.element_count(), 1e4);
      std::fill_n(lambda.begin(), 4, 3e5);
      const AveragedVolumeEnergy energy(elements, lambda, constitution);
      const Eigen::VectorXd rest = rest_positions(elements);
      EXPECT_NEAR(energy.value(rest), 0.0, 1e-15);
      Eigen::VectorXd bent = rest, motion = rest;
      // Little, because the stiffness leaves out what is as large as the pressure.
      std::uniform_real_distribution<double> uniform(-1e-5, 1e-5);
      for (Eigen::Index i = 0; i < bent.size(); ++i) {
        bent[i] += uniform(generator);
        motion[i] = uniform(generator);
      }
      const Eigen::VectorXd more = bent + 1e-3 * motion, less = bent - 1e-3 * motion;
      EXPECT_NEAR((energy.value(more) - energy.value(less)) / 2e-3,
                  energy.gradient(bent).dot(motion), 1e-6 * energy.value(bent));
      HessianProduct product(elements, motion);
      energy.evaluate(bent, nullptr, &product);
      const Eigen::VectorXd change = (energy.gradient(more) - energy.gradient(less)) / 2e-3;
      EXPECT_LE((product.result() - change).norm(), 0.01 * change.norm());
    }
  }
}

// An even change of volume costs what it costs without averages, and so does a patch test's.
TEST(NearIncompressibility, WhereStrainIsEvenItChangesNothing) {
  for (const int order : {1, 2}) {
    const Body body = tissue_test::kuhn_block({2, 2, 2}, {0.02, 0.02, 0.02});
    const FiniteElements elements(body, order);
    const std::size_t count = elements.element_count();
    const AveragedVolumeEnergy averaged(elements, std::vector<double>(count, 2e4),
                                        Constitution::kLinear);
    const ElasticEnergy local(elements, std::vector<Lame>(count, Lame{0.0, 2e4}),
                              Constitution::kLinear);
    Mat3 stretch;
    stretch << 1.02, 0.01, 0.0, 0.0, 0.97, 0.02, 0.01, 0.0, 1.03;
    Eigen::VectorXd positions = rest_positions(elements);
    for (Eigen::Index i = 0; i < positions.size(); i += 3) {
      positions.segment<3>(i) = stretch * Vec3(positions.segment<3>(i));
    }
    EXPECT_NEAR(averaged.value(positions), local.value(positions), 1e-9 * local.value(positions));
    EXPECT_LE((averaged.gradient(positions) - local.gradient(positions)).norm(),
              1e-9 * local.gradient(positions).norm());
  }
}

TEST(NearIncompressibility, ABeamSagsAsFarAsAQuadraticReference) {
  constexpr double kPoisson = 0.4999;
  // Small strain: the reference without averages is half a per cent short at this size.
  const double reference = sag("linear", 2, 6, kPoisson, true);
  EXPECT_NEAR(sag("linear", 2, 6, kPoisson, false), reference, 0.02 * reference);
  EXPECT_NEAR(sag("linear", 2, 4, kPoisson, true), reference, 0.05 * reference);
  // Linear tets, solved by iterations.
  const auto body = beam(16);
  const FiniteElements elements(*body, 1);
  const Lame lame = lame_of(5e4, kPoisson);
  const std::size_t count = elements.element_count();
  const ElasticEnergy local(elements, std::vector<Lame>(count, Lame{lame.mu, 1.5 * lame.mu}),
                            Constitution::kLinear);
  const AveragedVolumeEnergy averaged(
      elements, std::vector<double>(count, lame.lambda - 1.5 * lame.mu), Constitution::kLinear);
  const GravityEnergy gravity(elements, 1000.0, {0.0, 0.0, -9.81});
  EffectCost cost;
  Equilibrium equilibrium({&local, &averaged, &gravity},
                          squared_system(multigrid_system(elements, 1e-3), 1e-3, cost));
  equilibrium.hold(
      tissue_test::nodes_where(elements.rest(), [](const Vec3& p) { return p.x() < 1e-6; }));
  Eigen::VectorXd positions = rest_positions(elements);
  EXPECT_TRUE(equilibrium.solve(positions, {1e-3, 10}).converged);
  const std::vector<std::uint8_t> at_end = tissue_test::nodes_where(
      elements.rest(), [](const Vec3& p) { return (p - Vec3(0.2, 0.05, 0.05)).norm() < 1e-6; });
  const auto end = std::find(at_end.begin(), at_end.end(), 1) - at_end.begin();
  EXPECT_NEAR(0.05 - positions[3 * end + 2], reference, 0.05 * reference);
}

TEST(NearIncompressibility, LinearTetsBendWhereTheyLockWithoutIt) {
  for (const char* model : kModels) {
    const double soft = sag(model, 1, 4, 0.45, true), locked = sag(model, 1, 4, 0.4999, false),
                 free = sag(model, 1, 4, 0.4999, true);
    EXPECT_LT(locked, 0.5 * soft) << model;
    EXPECT_GT(free, 0.8 * soft) << model;
  }
}

// A ball of tissue with a tumour, between the table and a finger.
TEST(NearIncompressibility, APressedBallKeepsItsVolume) {
  const auto body = std::make_shared<Body>(body_of(tissue_test::refined_ball(0.024)));
  for (const char* model : {"corotational", "neo_hookean"}) {
    for (const int order : {1, 2}) {
      for (const char* more : {"", ", inertia, damping"}) {
        Scene scene(parse_scene("model: " + std::string(model) +
                                "\nelement_order: " + std::to_string(order) +
                                "\nmaterial: {young: [[60, 3e3], [255, 60e3]], poisson: 0.4999}\n"
                                "anchors: [{plane: {axis: z, below: 20%}}]\n"
                                "tools: [{name: finger, shape: {sphere: 0.015}, mode: press}]\n"
                                "effects: [density_response, contact, near_incompressibility" +
                                more + "]\n"),
                    body);
        for (const double depth : {-0.001, 0.003, 0.006}) {
          const StepReport report = scene.step(ToolPose{Vec3(0.001, 0.001, 0.045 - depth)}, 0.02);
          EXPECT_FALSE(report.not_converged) << model << order << more;
        }
        EXPECT_GT(scene.tool_forces()[0]->z(), 0.05);
        EXPECT_LE(std::abs(swelling(scene)), 0.005) << model << order << more;
      }
    }
  }
}

TEST(NearIncompressibility, IsForElements) {
  EXPECT_NE(tissue_test::refusal([] {
              parse_scene("model: mass_spring\neffects: [near_incompressibility]\n");
            }).find("is not an effect of model mass_spring"),
            std::string::npos);
}

}  // namespace
