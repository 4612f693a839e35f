// What meshing costs: the whole way from a volume in memory to a finished mesh, by size, method and
// number of threads. Run by scripts/benchmark.
#include "support/shapes.h"
#include "tissue/base/error.h"
#include "tissue/refine/build_mesh.h"

#include <benchmark/benchmark.h>

#include <cmath>

namespace {

const tissue_test::VolumePtr& organ() {
  static const tissue_test::VolumePtr volume = tissue_test::organ_phantom({224, 320, 190});
  return volume;
}

tissue::MeshOptions options_for(double spacing, int threads) {
  tissue::MeshOptions options;
  options.spacing = spacing;
  options.threads = threads;
  options.project_boundary = false;
  return options;
}

void build(benchmark::State& state, const tissue::MeshOptions& options) {
  tissue::MeshStatistics statistics;
  std::map<std::string, double> stages;
  double cpu_seconds = 0.0;
  for (auto _ : state) {
    const tissue::BuiltMesh built = tissue::build_mesh(organ(), nullptr, options);
    statistics = built.mesh.statistics;
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
  for (const auto& [name, seconds] : stages) state.counters["s_" + name] = seconds / rounds;
}

void density(benchmark::State& state) {
  build(state,
        options_for(1e-5 * static_cast<double>(state.range(0)), static_cast<int>(state.range(1))));
}

}  // namespace

BENCHMARK(density)->Args({1000, 1})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_MAIN();
