// Finite elements on meshes from the mesher, and on published problems.
#include "support/bodies.h"
#include "support/known_solutions.h"
#include "support/problem.h"
#include "support/shapes.h"
#include "tissue/refine/build_mesh.h"

namespace {

using namespace tissue;
using tissue_test::boundary_nodes;
using tissue_test::kuhn_block;
using tissue_test::nodes_where;
using tissue_test::Problem;

TEST(Solutions, TumourSphereOnDensityRefinedMeshesComesNearerAsTheyGetFiner) {
  const double coarse =
      tissue_test::tumour_sphere_error(tissue_test::refined_ball(0.020), 1, Constitution::kLinear);
  const double fine =
      tissue_test::tumour_sphere_error(tissue_test::refined_ball(0.010), 1, Constitution::kLinear);
  EXPECT_LT(fine, coarse / 1.8);
}

// A hollow ball of 12 and 30 mm around the origin, of tets of about one size.
Body hollow_ball(double spacing) {
  constexpr std::uint32_t kSize = 72;
  constexpr double kCentre = 0.5 * (kSize - 1);
  auto volume =
      std::make_shared<Volume>(*tissue_test::float_volume(kSize, [](double x, double y, double z) {
        const double r = Vec3(x - kCentre, y - kCentre, z - kCentre).norm();
        return 100.0 + 5.0 * std::min(30.0 - r, r - 12.0);
      }));
  volume->grid.origin = Vec3::Constant(-1e-3 * kCentre);
  MeshOptions options;
  options.iso_value = 100.0;
  options.method = Method::kUniform;
  options.spacing = spacing;
  return body_of(build_mesh(volume, nullptr, options).mesh);
}

// Relative L2 error over the nodes of Lamé's sphere under inner pressure (FACTS.md), its boundary
// moved as the solution says, so that what is left is the elements' own error.
double lame_sphere_error(const Body& body, int order) {
  constexpr double kPoisson = 0.3, kOuter = 0.030;
  Problem problem(body, order, Constitution::kLinear, {{{0.0, 3e3}}, kPoisson, 1000.0});
  const auto expected = [&](const Vec3& place) -> Vec3 {
    const double r = place.norm(), cube = kOuter * kOuter * kOuter;
    return 1e-3 * ((1.0 - 2.0 * kPoisson) + (1.0 + kPoisson) * cube / (2.0 * r * r * r)) * place;
  };
  const std::vector<std::uint8_t> held = boundary_nodes(problem);
  const std::vector<Vec3>& rest = problem.elements.rest();
  for (std::size_t node = 0; node < held.size(); ++node) {
    if (held[node] != 0) problem.move(node, expected(rest[node]));
  }
  EXPECT_TRUE(problem.solve(held).converged);
  double squares = 0.0, all = 0.0;
  for (std::size_t node = 0; node < held.size(); ++node) {
    squares += (problem.displacement(node) - expected(rest[node])).squaredNorm();
    all += expected(rest[node]).squaredNorm();
  }
  return std::sqrt(squares / all);
}

// Of half the size, elements of order 1 miss a quarter in the mean square, those of order 2 an
// eighth.
TEST(Solutions, LamesSphereComesNearerAtTheElementsOrder) {
  const Body coarse = hollow_ball(0.012), fine = hollow_ball(0.006);
  const double first = lame_sphere_error(coarse, 1) / lame_sphere_error(fine, 1);
  const double second = lame_sphere_error(coarse, 2) / lame_sphere_error(fine, 2);
  EXPECT_GT(first, 3.0) << first;
  EXPECT_GT(second, 6.0) << second;
}

// Forces on nodes that stay as they are.
class DeadLoad : public Energy {
 public:
  explicit DeadLoad(Eigen::VectorXd forces) : forces_(std::move(forces)) {}
  double evaluate(const Eigen::VectorXd& x, Eigen::VectorXd* gradient, Hessian*) const override {
    if (gradient != nullptr) *gradient -= forces_;
    return -forces_.dot(x);
  }

 private:
  Eigen::VectorXd forces_;
};

// The nodes of a face between three vertices and their shares of a traction: a third each for order
// 1; nothing for corners and a third for midpoints for order 2.
std::vector<std::size_t> loaded_nodes(const Problem& problem, const Triangle& triangle) {
  if (problem.elements.order() == 1) return {triangle[0], triangle[1], triangle[2]};
  std::vector<std::size_t> nodes;
  const std::vector<Edge>& midpoints = problem.elements.midpoints();
  for (int k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
    const auto found = std::find(midpoints.begin(), midpoints.end(), Edge{low, high});
    nodes.push_back(problem.body.rest.size() + static_cast<std::size_t>(found - midpoints.begin()));
  }
  return nodes;
}

// Upward displacement of the top right corner of Cook's membrane [mm] (FACTS.md).
double cooks_corner(int cells, int order) {
  constexpr double kThickness = 0.004;
  Body body = kuhn_block({cells, cells, 1}, {1.0, 1.0, kThickness});
  std::size_t corner = 0;
  for (std::size_t v = 0; v < body.rest.size(); ++v) {
    const double s = body.rest[v].x(), t = body.rest[v].y();
    if (s > 0.999 && t > 0.999) corner = v;
    body.rest[v].x() = static_cast<float>(0.048 * s);
    body.rest[v].y() = static_cast<float>(0.044 * s + t * (0.044 - 0.028 * s));
  }
  Problem problem(std::move(body), order, Constitution::kLinear, {{{0.0, 70e6}}, 1.0 / 3.0, 1.0});
  const std::vector<Vec3>& rest = problem.elements.rest();
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(problem.positions.size());
  for (const Triangle& triangle : problem.body.surface) {
    const Vec3 a = rest[triangle[0]], b = rest[triangle[1]], c = rest[triangle[2]];
    if (std::min({a.x(), b.x(), c.x()}) < 0.048 - 1e-6) continue;
    const double area = 0.5 * (b - a).cross(c - a).norm();
    for (const std::size_t node : loaded_nodes(problem, triangle)) {
      forces[static_cast<Eigen::Index>(3 * node + 1)] += 6.25e6 * area / 3.0;
    }
  }
  const DeadLoad load(forces);
  // Plane strain: nothing moves across.
  std::vector<std::uint8_t> fixed;
  for (const Vec3& place : rest) {
    const bool clamped = place.x() < 1e-6;
    fixed.insert(fixed.end(), {clamped, clamped, true});
  }
  Equilibrium equilibrium({&problem.energy, &load}, direct_system(problem.elements), {}, true);
  equilibrium.hold_coordinates(fixed);
  EXPECT_TRUE(equilibrium.solve(problem.positions, {1e-9, 10}).converged);
  return 1e3 * problem.displacement(corner).y();
}

TEST(Solutions, CooksMembraneBendsAsFarAsPublished) {
  const double corner = cooks_corner(16, 2);
  EXPECT_GT(corner, 32.0);
  EXPECT_LT(corner, 32.4);
}

// Pressure that inflates a thick shell of stable neo-Hookean tissue that keeps its volume
// (FACTS.md).
double shell_pressure(const Lame& lame, double stretch_inside, double stretch_outside) {
  const double mu = 4.0 / 3.0 * lame.mu;
  const auto integrand = [&](double s) {
    // W = μ/2 (I − 3) − μ/2 log(I + 1) with I = 2λ² + λ⁻⁴.
    const double squares = 2.0 * s * s + std::pow(s, -4.0);
    const double slope = 4.0 * s - 4.0 * std::pow(s, -5.0);
    return 0.5 * mu * slope * (1.0 - 1.0 / (squares + 1.0)) / (s * s * s - 1.0);
  };
  constexpr int kParts = 2000;
  const double width = (stretch_inside - stretch_outside) / kParts;
  double sum = 0.0;
  for (int i = 0; i < kParts; ++i) sum += width * integrand(stretch_outside + (i + 0.5) * width);
  return sum;
}

TEST(Solutions, AnInflatedShellAnswersWithThePressureOfIncompressibleTissue) {
  constexpr double kInner = 0.012, kOuter = 0.030, kStretch = 1.3, kPoisson = 0.49;
  Problem problem(hollow_ball(0.009), 2, Constitution::kNeoHookean,
                  {{{0.0, 3e3}}, kPoisson, 1000.0});
  const std::vector<Vec3>& rest = problem.elements.rest();
  std::vector<std::uint8_t> held = boundary_nodes(problem);
  for (std::size_t node = 0; node < rest.size(); ++node) {
    held[node] = held[node] != 0 && rest[node].norm() < 0.018;
    if (held[node] != 0) problem.move(node, (kStretch - 1.0) * rest[node]);
  }
  EXPECT_TRUE(problem.solve(held, nullptr, 1e-8).converged);
  const Eigen::VectorXd gradient = problem.energy.gradient(problem.positions);
  double outward = 0.0;
  for (std::size_t node = 0; node < rest.size(); ++node) {
    if (held[node] == 0) continue;
    outward +=
        gradient.segment<3>(static_cast<Eigen::Index>(3 * node)).dot(rest[node].normalized());
  }
  const double pressure = outward / (4.0 * M_PI * std::pow(kStretch * kInner, 2));
  const double outer_stretch =
      std::cbrt(1.0 + (std::pow(kStretch, 3) - 1.0) * std::pow(kInner / kOuter, 3));
  const double expected = shell_pressure(lame_of(3e3, kPoisson), kStretch, outer_stretch);
  EXPECT_NEAR(pressure, expected, 0.05 * expected);
}

}  // namespace
