// The iterative way of solving, against the direct one.
#include "tissue/simulate/damping.h"
#include "tissue/simulate/multigrid_system.h"
#include "tissue/simulate/quadratic_system.h"

#include "support/bodies.h"
#include "support/problem.h"

#include <random>

namespace {

using namespace tissue;
using tissue_test::kSoft;
using tissue_test::nodes_where;
using tissue_test::Problem;

Body halved_block() { return tissue_test::kuhn_block({16, 8, 8}, {0.2, 0.1, 0.1}, 2); }

Body with_inclusion(Body body, const Vec3& centre, double radius) {
  return tissue_test::with_core(std::move(body), centre, radius, 2.0f, 1.0f);
}

// Both solvers on the stiffness of a bent body with random forces; half the coordinates of one
// node, and all of some, are held.
void expect_same(Body body, int order, const Material& material,
                 Constitution constitution = Constitution::kCorotational) {
  Problem problem(std::move(body), order, constitution, material);
  for (Eigen::Index i = 0; i < problem.positions.size(); i += 3) {
    const double x = problem.positions[i];
    problem.positions[i + 2] += 1.5 * x * x;
  }
  std::vector<std::uint8_t> fixed(3 * problem.elements.node_count(), 0);
  const std::vector<Vec3>& rest = problem.elements.rest();
  double low = rest[0].x();
  for (const Vec3& place : rest) low = std::min(low, place.x());
  for (std::size_t node = 0; node < rest.size(); ++node) {
    if (rest[node].x() > low + 0.01) continue;
    for (std::size_t i = 0; i < 3; ++i) fixed[3 * node + i] = 1;
  }
  fixed[3 * rest.size() - 1] = 1;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  Eigen::VectorXd forces(problem.positions.size()), exact, found;
  for (double& value : forces) value = normal(random);
  const auto solve = [&](LinearSystem& system) {
    Eigen::VectorXd x;
    problem.energy.evaluate(problem.positions, nullptr, &system);
    system.finish();
    EXPECT_TRUE(system.prepare(fixed, 0.0));
    EXPECT_TRUE(system.solve(forces, x));
    return x;
  };
  const auto direct = direct_system(problem.elements);
  // All in single precision, quadratic elements come less near.
  const double tolerance = order == 1 ? 1e-6 : 1e-4;
  const auto multigrid = order == 1 ? multigrid_system(problem.elements, tolerance)
                                    : quadratic_system(problem.elements, constitution, tolerance);
  ASSERT_TRUE(multigrid);
  exact = solve(*direct);
  found = solve(*multigrid);
  Eigen::VectorXd product = Eigen::VectorXd::Zero(exact.size()), other = product;
  direct->multiply_add(forces, product);
  multigrid->multiply_add(forces, other);
  EXPECT_LE((product - other).norm(), 1e-6 * product.norm());
  EXPECT_LE((found - exact).norm(), 1e-3 * exact.norm());
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (fixed[i] != 0) {
      EXPECT_EQ(found[static_cast<Eigen::Index>(i)], 0.0);
    }
  }
}

TEST(Multigrid, AnswersAsTheFactorisationDoes) {
  const Material contrast = {{{1.0, 1e4}, {2.0, 1e6}}, 0.45, 1000.0};
  for (const int order : {1, 2}) {
    expect_same(halved_block(), order, kSoft);
    expect_same(with_inclusion(halved_block(), Vec3(0.1, 0.05, 0.05), 0.03), order, contrast);
    expect_same(with_inclusion(body_of(tissue_test::refined_ball(0.020)), Vec3::Zero(), 0.012),
                order, contrast);
    expect_same(halved_block(), order, kSoft, Constitution::kNeoHookean);
    // Without a hierarchy, over lattices.
    expect_same(tissue_test::kuhn_block({16, 8, 8}, {0.2, 0.1, 0.1}), order, kSoft);
  }
}

TEST(Multigrid, LeavesFewVerticesToFactorisations) {
  const FiniteElements plain(tissue_test::kuhn_block({2, 2, 2}, {1, 1, 1}), 1);
  EXPECT_FALSE(multigrid_system(plain, 1e-3));
}

// Energies that have the same elements, such as tissue and its damping, add up.
TEST(Multigrid, AddsWhatSeveralEnergiesHave) {
  for (const int order : {1, 2}) {
    Problem problem(halved_block(), order, Constitution::kCorotational, kSoft);
    const MassMatrix mass(problem.elements, 1000.0);
    DampingEnergy damping(problem.energy, problem.elements, mass, 3.0, 0.02);
    damping.begin_step(problem.positions, 0.01);
    Eigen::VectorXd bent = problem.positions, product = Eigen::VectorXd::Zero(bent.size()),
                    expected = product;
    for (Eigen::Index i = 0; i < bent.size(); i += 3) bent[i + 2] += 1.5 * bent[i] * bent[i];
    const auto direct = direct_system(problem.elements);
    const auto iterative =
        order == 1 ? multigrid_system(problem.elements, 1e-3)
                   : quadratic_system(problem.elements, Constitution::kCorotational, 1e-3);
    const std::uint32_t* nodes = problem.elements.nodes(7);
    const Edge edge = order == 1 ? Edge{nodes[0], nodes[1]} : Edge{nodes[0], nodes[4]};
    const Mat3 stiff = 1e3 * Vec3(1.0, 2.0, 3.0).asDiagonal();
    // Twice: what was added before is gone.
    for (int pass = 0; pass < 2; ++pass) {
      for (LinearSystem* system : {direct.get(), iterative.get()}) {
        system->set_zero();
        problem.energy.evaluate(bent, nullptr, system);
        damping.evaluate(bent, nullptr, system);
        // And what couples a few nodes: vertices, an edge's end with its midpoint, two midpoints.
        const auto last = static_cast<std::uint32_t>(problem.elements.node_count() - 1);
        for (const auto& [a, b] : {Edge{5, 5}, Edge{last, last}, edge}) {
          system->add(a, b, a == b ? stiff : Mat3(-0.5 * stiff));
        }
        system->finish();
      }
    }
    const Eigen::VectorXd way = bent - problem.positions + 0.01 * bent;
    direct->multiply_add(way, expected);
    iterative->multiply_add(way, product);
    EXPECT_LE((product - expected).norm(), 1e-4 * expected.norm());
  }
}

TEST(Multigrid, LeavesToOthersWhatItCannotSolve) {
  Problem problem(halved_block(), 1, Constitution::kLinear, kSoft);
  const std::vector<Vec3>& rest = problem.elements.rest();
  const auto held = nodes_where(rest, [](const Vec3& p) { return p.x() < 0.01; });
  for (std::size_t node = 0; node < rest.size(); ++node) {
    if (rest[node].x() > 0.19) problem.move(node, Vec3(0.001, 0.0, 0.0));
  }
  const std::vector<const Energy*> energies = {&problem.energy};
  // Nearer than numbers are.
  const auto impossible = [&] { return multigrid_system(problem.elements, 1e-30); };
  Equilibrium alone(energies, impossible());
  alone.hold(held);
  Eigen::VectorXd positions = problem.positions;
  EXPECT_FALSE(alone.solve(positions, {1e-6, 5}).converged);
  EXPECT_STREQ(alone.solver_name(), "multigrid");
  Equilibrium helped(energies, impossible(), [&] { return eigen_system(problem.elements); });
  helped.hold(held);
  EXPECT_TRUE(helped.solve(problem.positions, {1e-6, 5}).converged);
  EXPECT_STREQ(helped.solver_name(), "ldlt");
}

}  // namespace
