// What a step costs, by model, order of the elements and size. scripts/benchmark runs it and keeps
// the results.
#include "grasped_beam.h"

#include <benchmark/benchmark.h>

namespace {

using tissue::Model;

// Arguments: cells across the beam (it is twice as long), order of the elements.
void moved_patch(benchmark::State& state, Model model) {
  const int across = static_cast<int>(state.range(0));
  tissue_test::GraspedBeam beam({2 * across, across, across}, model,
                                static_cast<int>(state.range(1)));
  beam.step();  // What is computed once, is.
  double iterations = 0.0, failed = 0.0;
  for (auto _ : state) {
    const tissue::StepReport report = beam.step();
    iterations += report.iterations;
    failed += report.not_converged;
  }
  const auto vertices = static_cast<double>(beam.scene().body().rest.size());
  const auto steps = static_cast<double>(state.iterations());
  state.counters["vertices"] = vertices;
  state.counters["tets"] = static_cast<double>(beam.scene().body().tets.size());
  state.counters["iterations"] = iterations / steps;
  state.counters["not_converged"] = failed;
  // Inverted, because the library gives rates by the second alone: seconds per vertex.
  state.counters["s_per_vertex"] = benchmark::Counter(
      vertices * steps, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void closed_form(benchmark::State& state) { moved_patch(state, Model::kClosedForm); }
void linear(benchmark::State& state) { moved_patch(state, Model::kLinear); }
void corotational(benchmark::State& state) { moved_patch(state, Model::kCorotational); }
void neo_hookean(benchmark::State& state) { moved_patch(state, Model::kNeoHookean); }

// 1,377 to 18,081 vertices; 6,144 to 96,000 tets.
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
