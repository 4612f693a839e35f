// The iterative way of solving, against the direct one.
#include "tissue/simulate/multigrid.h"

#include "support/bodies.h"
#include "support/problem.h"

#include <random>

namespace {

using namespace tissue;
using tissue_test::kSoft;
using tissue_test::nodes_where;
using tissue_test::Problem;

Body halved_block() { return tissue_test::kuhn_block({16, 8, 8}, {0.2, 0.1, 0.1}, 2); }

// Young's modulus by whether a tet is in the body's middle.
Body with_inclusion(Body body, const Vec3& centre, double radius) {
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    Vec3 centroid = Vec3::Zero();
    for (const std::uint32_t v : body.tets[t]) centroid += 0.25 * body.rest[v].cast<double>();
    body.tet_densities[t] = (centroid - centre).norm() < radius ? 2.0f : 1.0f;
  }
  return body;
}

// Both solvers on the stiffness of a bent body with random forces; half the coordinates of one
// node, and all of some, are held.
void expect_same(Body body, int order, const Material& material) {
  Problem problem(std::move(body), order, Constitution::kCorotational, material);
  for (Eigen::Index i = 0; i < problem.positions.size(); i += 3) {
    const double x = problem.positions[i];
    problem.positions[i + 2] += 1.5 * x * x;
  }
  BlockMatrix hessian = problem.elements.empty_matrix();
  problem.energy.add_hessian(problem.positions, hessian);
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
  const auto direct = direct_solver();
  ASSERT_TRUE(direct->prepare(hessian, fixed, 0.0));
  ASSERT_TRUE(direct->solve(forces, exact));
  const auto multigrid = multigrid_solver(problem.elements, 1e-6);
  ASSERT_TRUE(multigrid);
  ASSERT_TRUE(multigrid->prepare(hessian, fixed, 0.0));
  ASSERT_TRUE(multigrid->solve(forces, found));
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
  }
}

TEST(Multigrid, NeedsAHierarchy) {
  const FiniteElements plain(tissue_test::kuhn_block({2, 2, 2}, {1, 1, 1}), 1);
  EXPECT_FALSE(multigrid_solver(plain, 1e-3));
  // Quadratic elements are their own: the linear ones lie below.
  const FiniteElements quadratic(tissue_test::kuhn_block({2, 2, 2}, {1, 1, 1}), 2);
  EXPECT_TRUE(multigrid_solver(quadratic, 1e-3));
}

TEST(Multigrid, LeavesToOthersWhatItCannotSolve) {
  const FiniteElements elements(halved_block(), 1);
  const std::vector<Lame> lame(elements.element_count(), lame_of(1e4, 0.3));
  const ElasticEnergy energy(elements, lame, Constitution::kLinear);
  BlockMatrix stiffness = elements.empty_matrix();
  energy.add_hessian(rest_positions(elements), stiffness);
  std::vector<std::uint8_t> fixed(3 * elements.node_count(), 0);
  std::fill_n(fixed.begin(), 30, std::uint8_t{1});
  const Eigen::VectorXd pull = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(fixed.size()));
  Eigen::VectorXd x;
  // Nearer than numbers are.
  const auto solver = with_fallback(multigrid_solver(elements, 1e-30), eigen_solver());
  ASSERT_TRUE(solver->prepare(stiffness, fixed, 0.0));
  EXPECT_STREQ(solver->name(), "multigrid");
  EXPECT_TRUE(solver->solve(pull, x));
  EXPECT_STREQ(solver->name(), "ldlt");
  Eigen::VectorXd product = Eigen::VectorXd::Zero(x.size());
  stiffness.multiply_add(x, product);
  for (std::size_t i = 30; i < fixed.size(); ++i) {
    EXPECT_NEAR(product[static_cast<Eigen::Index>(i)], 1.0, 1e-6);
  }
  // A matrix that is not positive definite nobody solves.
  stiffness.add(BlockMatrix(stiffness), -2.0);
  EXPECT_FALSE(solver->prepare(stiffness, fixed, 0.0));
}

}  // namespace
