// What the stages of a Newton step cost: a bent beam, by order of the elements and size.
// scripts/benchmark runs it and keeps the results.
#include "support/bodies.h"
#include "tissue/simulate/elastic_energy.h"
#include "tissue/simulate/inertia.h"
#include "tissue/simulate/material.h"
#include "tissue/simulate/multigrid_system.h"
#include "tissue/simulate/quadratic_system.h"

#include <benchmark/benchmark.h>

namespace {

using namespace tissue;

// Everything up to, but not, what is measured.
struct Beam {
  explicit Beam(const benchmark::State& state)
      : body(tissue_test::kuhn_block(
            {2 * static_cast<int>(state.range(0)), static_cast<int>(state.range(0)),
             static_cast<int>(state.range(0))},
            {0.2, 0.1, 0.1}, 2)),
        elements(body, static_cast<int>(state.range(1))),
        tissue(elements, std::vector<Lame>(body.tets.size(), lame_of(5e4, 0.45)),
               Constitution::kCorotational, one_thread()),
        inertia(elements, 1000.0),
        system(elements.order() == 1
                   ? multigrid_system(elements, 1e-3, one_thread())
                   : quadratic_system(elements, Constitution::kCorotational, 1e-3, one_thread())),
        positions(rest_positions(elements)),
        fixed(3 * elements.node_count(), 0) {
    inertia.begin_step(positions, Eigen::VectorXd::Zero(positions.size()), 0.01);
    for (std::size_t node = 0; node < elements.node_count(); ++node) {
      const Vec3& rest = elements.rest()[node];
      if (rest.x() < 1e-6) std::fill_n(&fixed[3 * node], 3, std::uint8_t{1});
      positions[static_cast<Eigen::Index>(3 * node + 2)] -= rest.x() * rest.x();
    }
  }
  static Run one_thread() {
    Run run;
    run.threads = 1;
    return run;
  }
  void assemble() {
    system->set_zero();
    tissue.evaluate(positions, nullptr, system.get());
    inertia.evaluate(positions, nullptr, system.get());
    system->finish();
  }

  Body body;
  FiniteElements elements;
  ElasticEnergy tissue;
  InertiaEnergy inertia;
  std::unique_ptr<LinearSystem> system;
  Eigen::VectorXd positions;
  std::vector<std::uint8_t> fixed;
};

template <class Stage>
void measure(benchmark::State& state, const Beam& beam, const Stage& stage) {
  for (auto _ : state) stage();
  const auto tets = static_cast<double>(beam.body.tets.size());
  state.counters["tets"] = tets;
  state.counters["s_per_tet"] =
      benchmark::Counter(tets * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

// Rotations and strains.
void stage_energy(benchmark::State& state) {
  const Beam beam(state);
  measure(state, beam, [&] { benchmark::DoNotOptimize(beam.tissue.value(beam.positions)); });
}

void stage_forces(benchmark::State& state) {
  const Beam beam(state);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(beam.positions.size());
  measure(state, beam, [&] { beam.tissue.evaluate(beam.positions, &gradient, nullptr); });
}

// The Hessian, with rotations and stretches, into what is solved with.
void stage_assembly(benchmark::State& state) {
  Beam beam(state);
  measure(state, beam, [&] { beam.assemble(); });
}

// Galerkin's coarse matrices and what smoothers need.
void stage_preconditioner(benchmark::State& state) {
  Beam beam(state);
  beam.assemble();
  measure(state, beam, [&] {
    if (!beam.system->prepare(beam.fixed, 0.0)) state.SkipWithError("not positive definite");
  });
}

// All iterations of conjugate gradients to 1e-3.
void stage_iterations(benchmark::State& state) {
  Beam beam(state);
  beam.assemble();
  if (!beam.system->prepare(beam.fixed, 0.0)) state.SkipWithError("not positive definite");
  const Eigen::VectorXd forces = beam.tissue.gradient(beam.positions);
  Eigen::VectorXd step;
  measure(state, beam, [&] {
    if (!beam.system->solve(forces, step)) state.SkipWithError("not solved");
  });
}

#define TISSUE_STAGE(name) \
  BENCHMARK(name)->Unit(benchmark::kMillisecond)->ArgsProduct({{8, 12, 20}, {1}})->Args({8, 2})
TISSUE_STAGE(stage_energy);
TISSUE_STAGE(stage_forces);
TISSUE_STAGE(stage_assembly);
TISSUE_STAGE(stage_preconditioner);
TISSUE_STAGE(stage_iterations);

}  // namespace

BENCHMARK_MAIN();
