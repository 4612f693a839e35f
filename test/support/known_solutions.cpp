#include "support/known_solutions.h"

#include "support/bodies.h"
#include "support/problem.h"
#include "tissue/simulate/spring_energy.h"

#include <stdexcept>

namespace tissue_test {
namespace {

void require(const EquilibriumReport& report) {
  if (report.converged) return;
  throw std::runtime_error("no equilibrium: residual " + std::to_string(report.residual));
}

// Puts springs into a problem's body where there is no constitution.
struct Springs {
  std::optional<SpringEnergy> energy;
  Springs(Problem& problem, const Material& material, const Tissue& tissue) {
    if (tissue) return;
    energy.emplace(problem.elements, young_of(material, problem.body));
    problem.tissue = &*energy;
  }
};

}  // namespace

TumourSphere::TumourSphere(double radius, double outer_radius, double moved, const Lame& tissue,
                           const Lame& tumour)
    : radius_(radius) {
  const double k_m = tissue.lambda + 2.0 / 3.0 * tissue.mu;
  const double k_i = tumour.lambda + 2.0 / 3.0 * tumour.mu;
  const double cube = radius * radius * radius;
  // e = A + B/a³ and 3 K_i e = 3 K_m A − 4 μ_m B/a³ and A b + B/b² = U.
  const double ratio = 3.0 * (k_m - k_i) / (3.0 * k_i + 4.0 * tissue.mu);
  a_ = moved / (outer_radius + ratio * cube / (outer_radius * outer_radius));
  b_ = ratio * cube * a_;
  inner_ = a_ + b_ / cube;
}

Vec3 TumourSphere::displacement(const Vec3& place) const {
  const double r = place.norm();
  return r < radius_ ? Vec3(inner_ * place) : Vec3((a_ + b_ / (r * r * r)) * place);
}

double tumour_sphere_error(const TetMesh& mesh, int order, const Tissue& tissue) {
  constexpr double kRadius = 0.010, kMoved = 1e-4;
  Body body = ball_body(mesh, kRadius, 255.0f, 60.0f);
  double outer = 0.0;
  for (const Triangle& triangle : body.surface) {
    for (const std::uint32_t v : triangle) outer += body.rest[v].cast<double>().norm();
  }
  outer /= 3.0 * static_cast<double>(body.surface.size());
  const Material material = {{{60.0, 3e3}, {255.0, 6e4}}, 0.3, 1000.0};
  Problem problem(std::move(body), order, tissue.value_or(Constitution::kLinear), material);
  const Springs springs(problem, material, tissue);
  const TumourSphere exact(kRadius, outer, kMoved, lame_of(3e3, 0.3), lame_of(6e4, 0.3));
  const std::vector<std::uint8_t> held = boundary_nodes(problem);
  for (std::size_t node = 0; node < held.size(); ++node) {
    if (held[node] != 0) problem.move(node, exact.displacement(problem.elements.rest()[node]));
  }
  require(problem.solve(held));
  double squares = 0.0, all = 0.0;
  for (std::size_t node = 0; node < held.size(); ++node) {
    const Vec3 wanted = exact.displacement(problem.elements.rest()[node]);
    squares += (problem.displacement(node) - wanted).squaredNorm();
    all += wanted.squaredNorm();
  }
  return std::sqrt(squares / all);
}

double beam_sag(const std::array<int, 3>& cells, int order, const Tissue& tissue) {
  Problem problem(kuhn_block(cells, {0.2, 0.1, 0.1}), order, tissue.value_or(Constitution::kLinear),
                  kSoft);
  const Springs springs(problem, kSoft, tissue);
  const std::vector<Vec3>& rest = problem.elements.rest();
  const GravityEnergy gravity(problem.elements, 1000.0, Vec3(0, 0, -9.81));
  const EquilibriumReport report =
      problem.solve(nodes_where(rest, [](const Vec3& p) { return p.x() < 1e-6; }), &gravity, 1e-8);
  require(report);
  double sum = 0.0;
  int count = 0;
  for (std::size_t node = 0; node < rest.size(); ++node) {
    if (rest[node].x() < 0.2 - 1e-6) continue;
    sum += std::abs(problem.displacement(node).z());
    ++count;
  }
  return sum / count;
}

}  // namespace tissue_test
