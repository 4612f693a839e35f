// Finite elements against what is known exactly.
#include "support/bodies.h"
#include "support/figures.h"
#include "support/known_solutions.h"
#include "support/problem.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <set>

namespace {

using namespace tissue;
using tissue_test::beam_sag;
using tissue_test::boundary_nodes;
using tissue_test::kSoft;
using tissue_test::kuhn_block;
using tissue_test::nodes_where;
using tissue_test::Problem;

// The largest error of an affine displacement of the boundary within the body, by its size.
double patch_error(Body body, int order, Constitution constitution) {
  Problem problem(std::move(body), order, constitution, kSoft);
  Mat3 gradient;
  gradient << 0.01, 0.02, -0.01, 0.005, -0.015, 0.01, 0.02, -0.005, 0.01;
  const std::vector<std::uint8_t> held = boundary_nodes(problem);
  for (std::size_t node = 0; node < held.size(); ++node) {
    if (held[node] != 0) problem.move(node, gradient * problem.elements.rest()[node]);
  }
  EXPECT_TRUE(problem.solve(held, nullptr, 1e-13).residual < 1e-9);
  double largest = 0.0, size = 0.0;
  for (std::size_t node = 0; node < held.size(); ++node) {
    const Vec3& rest = problem.elements.rest()[node];
    largest = std::max(largest, (problem.displacement(node) - gradient * rest).norm());
    size = std::max(size, rest.norm());
  }
  return largest / size;
}

TEST(Elasticity, T12_PatchTestHoldsOnUniformAndRefinedMeshesInEveryModelAndOrder) {
  const Body refined = body_of(tissue_test::refined_ball(0.016));
  const Body block = kuhn_block({3, 2, 2}, {0.03, 0.02, 0.02});
  for (const int order : {1, 2}) {
    for (const auto constitution :
         {Constitution::kLinear, Constitution::kCorotational, Constitution::kNeoHookean}) {
      const double error = patch_error(block, order, constitution);
      EXPECT_LE(error, 1e-10);
      tissue_test::figure("error, by the size", error);
    }
    const double error = patch_error(refined, order, Constitution::kLinear);
    EXPECT_LE(error, 1e-10);
    tissue_test::figure("error, by the size", error);
  }
}

TEST(Elasticity, T12_PatchTestFailsWhereANodeHangs) {
  Body body = kuhn_block({3, 3, 3}, {0.03, 0.03, 0.03});
  // The tet in the middle gets a vertex on its first edge that its neighbours know nothing of.
  const std::size_t middle = body.tets.size() / 2;
  const Tet tet = body.tets[middle];
  const auto added = static_cast<std::uint32_t>(body.rest.size());
  body.rest.push_back(0.5f * (body.rest[tet[0]] + body.rest[tet[1]]));
  body.tets[middle] = {added, tet[1], tet[2], tet[3]};
  body.tets.push_back({tet[0], added, tet[2], tet[3]});
  body.tet_densities.push_back(1.0f);
  EXPECT_GT(patch_error(body, 1, Constitution::kLinear), 1e-6);
}

TEST(Elasticity, T11_ForcesAndStiffnessOfAMeshAreDerivativesOfItsEnergy) {
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> uniform(-1e-8, 1e-8);
  for (const int order : {1, 2}) {
    for (const auto constitution :
         {Constitution::kLinear, Constitution::kCorotational, Constitution::kNeoHookean}) {
      Problem problem(kuhn_block({1, 1, 1}, {0.02, 0.02, 0.02}), order, constitution, kSoft);
      for (Eigen::Index i = 0; i < problem.positions.size(); ++i) {
        problem.positions[i] += uniform(generator);
      }
      const auto gradient_at = [&](const Eigen::VectorXd& x) { return problem.energy.gradient(x); };
      const Eigen::VectorXd gradient = gradient_at(problem.positions);
      AssembledHessian hessian(problem.elements);
      problem.energy.evaluate(problem.positions, nullptr, &hessian);
      const double h = 1e-7;
      for (Eigen::Index i = 0; i < problem.positions.size(); ++i) {
        Eigen::VectorXd unit = Eigen::VectorXd::Zero(problem.positions.size());
        unit[i] = 1.0;
        const Eigen::VectorXd more = problem.positions + h * unit,
                              less = problem.positions - h * unit;
        EXPECT_NEAR((problem.energy.value(more) - problem.energy.value(less)) / (2.0 * h),
                    gradient[i], 1e-3 * gradient.norm());
        Eigen::VectorXd column = Eigen::VectorXd::Zero(unit.size());
        hessian.matrix().multiply_add(unit, column);
        const Eigen::VectorXd difference = (gradient_at(more) - gradient_at(less)) / (2.0 * h);
        // So near to rest little had to be made convex; far from it the laws are tested alone.
        EXPECT_LE((column - difference).norm(), 1e-4 * difference.norm());
      }
    }
  }
}

TEST(Elasticity, T10_RigidMotionOfAMeshMakesNoForce) {
  Problem problem(kuhn_block({4, 2, 2}, {0.04, 0.02, 0.02}), 2, Constitution::kCorotational, kSoft);
  for (double degrees = 0.0; degrees <= 720.0; degrees += 45.0) {
    const Mat3 rotation =
        Eigen::AngleAxisd(degrees * M_PI / 180.0, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    for (std::size_t node = 0; node < problem.elements.node_count(); ++node) {
      problem.positions.segment<3>(static_cast<Eigen::Index>(3 * node)) =
          rotation * problem.elements.rest()[node] + Vec3(6, -8, 0);
    }
    const double force = problem.energy.gradient(problem.positions).norm() / (5e4 * 0.04 * 0.04);
    EXPECT_LE(force, 1e-9);
    tissue_test::figure("force, by E L^2", force);
  }
}

// Small strain has 55.8 mm as its limit, and what an order of elements misses of it was measured
// by others: −15.7 % and −2.6 % at 1,377 nodes.
TEST(Elasticity, AClampedBeamSagsAsFarAsItsModelHasItsLimit) {
  EXPECT_NEAR(1e3 * beam_sag({16, 8, 8}, 1, Constitution::kLinear), 55.8 * (1.0 - 0.157), 0.15);
  EXPECT_NEAR(1e3 * beam_sag({8, 4, 4}, 2, Constitution::kLinear), 55.8, 0.03 * 55.8);
  EXPECT_NEAR(1e3 * beam_sag({8, 4, 4}, 2, Constitution::kNeoHookean), 53.42, 0.05);
  EXPECT_NEAR(1e3 * beam_sag({8, 4, 4}, 2, Constitution::kCorotational), 54.3, 0.03 * 54.3);
}

TEST(Elasticity, ResultsAreTheSameInMillimetresAfterRenumberingAndWithTwoThreads) {
  const auto bent = [](double unit, bool renumbered, int threads) {
    Body body = kuhn_block({6, 3, 3}, {0.06 * unit, 0.03 * unit, 0.03 * unit});
    std::vector<std::uint32_t> number(body.rest.size());
    std::iota(number.begin(), number.end(), 0u);
    if (renumbered) {
      std::shuffle(number.begin(), number.end(), std::mt19937(4));
      std::vector<Vec3f> moved(body.rest.size());
      for (std::size_t v = 0; v < moved.size(); ++v) moved[number[v]] = body.rest[v];
      body.rest = moved;
      for (Tet& tet : body.tets) {
        for (std::uint32_t& v : tet) v = number[v];
      }
    }
    // The same tissue: Pa are kg/(m s²), so numbers fall as the unit of length shrinks.
    const Material material = {{{0.0, 5e4 / unit}}, 0.45, 1000.0 / (unit * unit * unit)};
    Problem problem(std::move(body), 1, Constitution::kNeoHookean, material, threads);
    const GravityEnergy gravity(problem.elements, material.mass_density, {0, 0, -9.81 * unit});
    EXPECT_TRUE(problem
                    .solve(nodes_where(problem.elements.rest(),
                                       [&](const Vec3& p) { return p.x() < 1e-6 * unit; }),
                           &gravity)
                    .converged);
    std::vector<Vec3> result;
    for (const std::uint32_t v : number) result.push_back(problem.displacement(v) / unit);
    return result;
  };
  const std::vector<Vec3> metres = bent(1.0, false, 1);
  EXPECT_EQ(metres, bent(1.0, false, 2));
  const std::vector<Vec3> millimetres = bent(1e3, false, 1), shuffled = bent(1.0, true, 1);
  for (std::size_t v = 0; v < metres.size(); ++v) {
    EXPECT_LE((metres[v] - millimetres[v]).norm(), 1e-7 * 0.06);
    EXPECT_LE((metres[v] - shuffled[v]).norm(), 1e-9 * 0.06);
  }
}

}  // namespace
