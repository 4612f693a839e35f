// What meshing costs: the whole way from a volume in memory to a finished mesh, and the stages of
// it, by size, method and number of threads. scripts/benchmark runs it and keeps the results.
#include "support/shapes.h"
#include "tissue/base/error.h"
#include "tissue/refine/build_mesh.h"

#include <benchmark/benchmark.h>

#include <atomic>
#include <chrono>
#include <map>
#include <thread>

namespace {

using tissue::MeshOptions;
using tissue::Method;

// As large as the paper's brain.
const tissue_test::VolumePtr& organ() {
  static const tissue_test::VolumePtr volume = tissue_test::organ_phantom({224, 320, 190});
  return volume;
}

// Arguments of every benchmark: spacing of the lattice [10 µm], threads.
MeshOptions options_for(const benchmark::State& state, Method method) {
  MeshOptions options;
  options.method = method;
  options.spacing = 1e-5 * static_cast<double>(state.range(0));
  return options;
}

tissue::Run run_for(const benchmark::State& state) {
  tissue::Run run;
  run.threads = static_cast<int>(state.range(1));
  return run;
}

void build(benchmark::State& state, const MeshOptions& options) {
  tissue::MeshStatistics statistics;
  std::map<std::string, double> stages;
  double cpu_seconds = 0.0;
  organ();  // Not part of the first round.
  for (auto _ : state) {
    statistics = tissue::build_mesh(organ(), nullptr, options, run_for(state)).mesh.statistics;
    for (const tissue::StageCost& stage : statistics.stages) {
      stages[stage.name] += stage.cpu_seconds;
      cpu_seconds += stage.cpu_seconds;
    }
  }
  const auto tets = static_cast<double>(statistics.tetrahedra);
  const auto rounds = static_cast<double>(state.iterations());
  state.counters["tets"] = tets;
  state.counters["tets_per_cpu_s"] = tets * rounds / cpu_seconds;
  state.counters["bytes_per_tet"] = static_cast<double>(statistics.peak_bytes) / tets;
  state.counters["astray_percent"] = 100.0 *
                                     static_cast<double>(statistics.boundary_vertices_astray) /
                                     static_cast<double>(statistics.boundary_vertices);
  for (const char* stage : {"lattice", "levels", "refinement", "projection", "densities"}) {
    state.counters[std::string("s_") + stage] = stages[stage] / rounds;
  }
}

void density_unprojected(benchmark::State& state) {
  MeshOptions options = options_for(state, Method::kDensity);
  options.project_boundary = false;
  build(state, options);
}

void density_4_sweeps(benchmark::State& state) {
  MeshOptions options = options_for(state, Method::kDensity);
  options.projection = {4, 0};
  build(state, options);
}

void density(benchmark::State& state) { build(state, options_for(state, Method::kDensity)); }
void surface(benchmark::State& state) { build(state, options_for(state, Method::kSurface)); }
void uniform(benchmark::State& state) { build(state, options_for(state, Method::kUniform)); }

// The longest that a build goes on after it was cancelled, of 25 moments spread over it.
void cancel(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::duration time) {
    return std::chrono::duration<double>(time).count();
  };
  const MeshOptions options = options_for(state, Method::kDensity);
  const Clock::time_point start = Clock::now();
  tissue::build_mesh(organ(), nullptr, options, run_for(state));
  const double whole = seconds(Clock::now() - start);
  for (auto _ : state) {
    double longest = 0.0;
    for (int moment = 0; moment < 25; ++moment) {
      tissue::Run run = run_for(state);
      run.cancelled = std::make_shared<std::atomic<bool>>(false);
      Clock::time_point asked;
      std::thread impatient([&] {
        std::this_thread::sleep_for(std::chrono::duration<double>(moment / 25.0 * whole));
        asked = Clock::now();
        *run.cancelled = true;
      });
      try {
        tissue::build_mesh(organ(), nullptr, options, run);
      } catch (const tissue::InputError&) {
      }
      const Clock::time_point ended = Clock::now();
      impatient.join();
      longest = std::max(longest, seconds(ended - asked));
    }
    state.SetIterationTime(longest);
  }
}

// From 10⁴ to 3·10⁷ tets.
void sizes(benchmark::internal::Benchmark* benchmark) {
  for (const int spacing : {5500, 2400, 1020, 530, 375}) benchmark->Args({spacing, 1});
  benchmark->Args({1020, 2});
  benchmark->Unit(benchmark::kMillisecond)->UseRealTime()->MinTime(2.0);
}

void one_size(benchmark::internal::Benchmark* benchmark, int spacing) {
  for (const int threads : {1, 2}) benchmark->Args({spacing, threads});
  benchmark->Unit(benchmark::kMillisecond)->UseRealTime()->MinTime(2.0);
}

}  // namespace

BENCHMARK(density_unprojected)->Apply(sizes);
BENCHMARK(density_4_sweeps)->Apply(sizes);
BENCHMARK(density)->Apply(sizes);
BENCHMARK(surface)->Apply([](auto* benchmark) { one_size(benchmark, 1020); });
BENCHMARK(uniform)->Apply([](auto* benchmark) { one_size(benchmark, 340); });
BENCHMARK(cancel)
    ->Args({1020, 2})
    ->Args({530, 2})
    ->Args({375, 2})
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(1);
BENCHMARK_MAIN();
