// Prints the README's table of models: what each is for, what it costs and how exact it is.
// scripts/model_table runs it.
#include "grasped_beam.h"
#include "support/known_solutions.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>

namespace {

using tissue::Constitution;
using tissue::Model;

// Sag of the beam as elements get ever finer [m]: small strain (springs are held against it too),
// co-rotated, stable neo-Hookean.
struct Row {
  Model model;
  const char* purpose;
  // Nothing for what solves no equation; within, nothing for springs.
  std::optional<tissue_test::Tissue> tissue;
  double limit;
};
const Row kRows[] = {
    {Model::kClosedForm, "the cheapest: no equation is solved", std::nullopt, 0.0},
    {Model::kMassSpring, "what most simulators offer", tissue_test::Tissue(), 0.0558},
    {Model::kLinear, "haptics; small deformations", Constitution::kLinear, 0.0558},
    {Model::kCorotational, "large rotations", Constitution::kCorotational, 0.0543},
    {Model::kNeoHookean, "the reference; large strains", Constitution::kNeoHookean, 0.05465},
};

struct StepTimes {
  double first, median;
};

StepTimes step_times(tissue_test::GraspedBeam& beam) {
  std::vector<double> milliseconds;
  for (int i = 0; i < 41; ++i) {
    const auto start = std::chrono::steady_clock::now();
    beam.step();
    milliseconds.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
            .count());
  }
  const double first = milliseconds.front();
  std::sort(milliseconds.begin() + 1, milliseconds.end());
  return {first, milliseconds[21]};
}

void print(const Row& row, int order) {
  // As many nodes for either order: 1,377.
  const std::array<int, 3> cells = order == 1 ? std::array{16, 8, 8} : std::array{8, 4, 4};
  tissue_test::GraspedBeam beam(cells, row.model, order);
  const StepTimes times = step_times(beam);
  std::printf("| `%s` | %s | %s | %zu | %.3g / %.3g | ", name(row.model),
              row.tissue ? std::to_string(order).c_str() : "–", row.purpose,
              beam.scene().body().tets.size(), times.first, times.median);
  if (!row.tissue) {
    std::printf("– | – | – |\n");
    return;
  }
  tissue_test::GraspedBeam moving(cells, row.model, order, {tissue::InertiaOptions{}});
  std::printf("%.3g | ", step_times(moving).median);
  const double sag = tissue_test::beam_sag(cells, order, *row.tissue);
  const tissue::TetMesh ball = tissue_test::refined_ball(order == 1 ? 0.010 : 0.020);
  const double error = tissue_test::tumour_sphere_error(ball, order, *row.tissue);
  std::printf("%.1f of %.1f mm (%+.1f %%) | %.2f %% (%zu) |\n", 1e3 * sag, 1e3 * row.limit,
              100.0 * (sag / row.limit - 1.0), 100.0 * error, ball.tets.size());
}

}  // namespace

int main() {
  std::printf(
      "| model | order | for | tets of the beam | first / next step [ms] | next step with inertia "
      "[ms] | sag of the beam | error on the tumour sphere (tets) "
      "|\n|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : kRows) {
    print(row, 1);
    if (row.tissue && *row.tissue) print(row, 2);
  }
}
