// What a step costs, by model, order of the elements and size. scripts/benchmark runs it and keeps
// the results.
#include "grasped_beam.h"
#include "tissue/simulate/scene_file.h"

#include <benchmark/benchmark.h>

namespace {

using tissue::Model;

// Measures steps and counts what they did, the same counters for all.
template <class Step>
void measure(benchmark::State& state, const tissue::Scene& scene, const Step& step) {
  double iterations = 0.0, failed = 0.0, residual = 0.0;
  for (auto _ : state) {
    const tissue::StepReport report = step();
    iterations += report.iterations;
    failed += report.not_converged;
    residual = std::max(residual, report.residual);
  }
  const auto vertices = static_cast<double>(scene.body().rest.size());
  const auto steps = static_cast<double>(state.iterations());
  state.counters["vertices"] = vertices;
  state.counters["tets"] = static_cast<double>(scene.body().tets.size());
  state.counters["iterations"] = iterations / steps;
  state.counters["not_converged"] = failed;
  state.counters["largest_residual"] = residual;
  // Inverted, because the library gives rates by the second alone: seconds per vertex.
  state.counters["s_per_vertex"] = benchmark::Counter(
      vertices * steps, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

// Arguments: cells across the beam (it is twice as long), order of the elements.
void moved_patch(benchmark::State& state, Model model) {
  const int across = static_cast<int>(state.range(0));
  tissue_test::GraspedBeam beam({2 * across, across, across}, model,
                                static_cast<int>(state.range(1)));
  beam.step();  // What is computed once, is.
  measure(state, beam.scene(), [&] { return beam.step(); });
}

void closed_form(benchmark::State& state) { moved_patch(state, Model::kClosedForm); }
void linear(benchmark::State& state) { moved_patch(state, Model::kLinear); }
void corotational(benchmark::State& state) { moved_patch(state, Model::kCorotational); }
void neo_hookean(benchmark::State& state) { moved_patch(state, Model::kNeoHookean); }

// One linearised step of implicit Euler of 10 ms: a clamped beam that starts to sag, mean over its
// first hundred steps. Arguments as above; with an inclusion a hundred times as stiff or without.
void implicit_step(benchmark::State& state) {
  const int across = static_cast<int>(state.range(0));
  tissue::Body body = tissue_test::kuhn_block({2 * across, across, across}, {0.2, 0.1, 0.1}, 2);
  for (std::size_t t = 0; state.range(2) != 0 && t < body.tets.size(); ++t) {
    tissue::Vec3 centroid = tissue::Vec3::Zero();
    for (const std::uint32_t v : body.tets[t]) centroid += 0.25 * body.rest[v].cast<double>();
    if ((centroid - tissue::Vec3(0.1, 0.05, 0.05)).norm() < 0.03) body.tet_densities[t] = 2.0f;
  }
  tissue::Scene scene(
      tissue::parse_scene("model: corotational\nelement_order: " + std::to_string(state.range(1)) +
                          "\nmaterial: {young: [[1, 50e3], [2, 5e6]], poisson: 0.45}\n"
                          "anchors: [{plane: {axis: x, below: 0.001}}]\n"
                          "effects: [density_response, gravity, inertia, {damping: {mass: 5}}]\n"),
      std::make_shared<tissue::Body>(std::move(body)));
  measure(state, scene, [&] { return scene.step(tissue::ToolPoses{}, 0.01); });
}

// 1,377 to 18,081 vertices; 6,144 to 96,000 tets.
BENCHMARK(implicit_step)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(100)
    ->Args({8, 1, 0})
    ->Args({12, 1, 0})
    ->Args({20, 1, 0})
    ->Args({8, 1, 1})
    ->Args({12, 1, 1})
    ->Args({20, 1, 1})
    ->Args({4, 2, 0})
    ->Args({8, 2, 0});
BENCHMARK(closed_form)->Args({8, 1})->Args({12, 1})->Args({20, 1});
BENCHMARK(linear)->Args({8, 1})->Args({12, 1})->Args({20, 1})->Args({4, 2})->Args({8, 2});
BENCHMARK(corotational)
    ->Unit(benchmark::kMillisecond)
    ->Args({8, 1})
    ->Args({12, 1})
    ->Args({4, 2})
    ->Args({8, 2});
BENCHMARK(neo_hookean)
    ->Unit(benchmark::kMillisecond)
    ->Args({8, 1})
    ->Args({12, 1})
    ->Args({4, 2})
    ->Args({8, 2});

}  // namespace

BENCHMARK_MAIN();
