// What a step costs, by model, order of the elements, effects and size. scripts/benchmark runs it
// and keeps the results.
#include "grasped_beam.h"
#include "tissue/base/peak_memory.h"
#include "tissue/simulate/scene_file.h"

#include <benchmark/benchmark.h>

namespace {

using tissue::Model;
using tissue::PeakMemory;

// Measures steps and counts what they did, the same counters for all.
template <class Step>
void measure(benchmark::State& state, const tissue::Scene& scene, const PeakMemory& memory,
             const Step& step) {
  double iterations = 0.0, failed = 0.0, residual = 0.0;
  for (auto _ : state) {
    const tissue::StepReport report = step();
    iterations += report.iterations;
    failed += report.not_converged;
    residual = std::max(residual, report.residual);
  }
  const auto vertices = static_cast<double>(scene.body().rest.size());
  const auto tets = static_cast<double>(scene.body().tets.size());
  const auto steps = static_cast<double>(state.iterations());
  state.counters["vertices"] = vertices;
  state.counters["tets"] = tets;
  state.counters["iterations"] = iterations / steps;
  state.counters["not_converged"] = failed;
  state.counters["largest_residual"] = residual;
  state.counters["bytes_per_tet"] = memory.bytes() / tets;
  // Inverted, because the library gives rates by the second alone: seconds per vertex.
  state.counters["s_per_vertex"] = benchmark::Counter(
      vertices * steps, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

// Arguments: cells across the beam (it is twice as long), order of the elements.
void moved_patch(benchmark::State& state, Model model) {
  const int across = static_cast<int>(state.range(0));
  const PeakMemory memory;
  tissue_test::GraspedBeam beam({2 * across, across, across}, model,
                                static_cast<int>(state.range(1)));
  beam.step();  // What is computed once, is.
  measure(state, beam.scene(), memory, [&] { return beam.step(); });
}

void closed_form(benchmark::State& state) { moved_patch(state, Model::kClosedForm); }
void linear(benchmark::State& state) { moved_patch(state, Model::kLinear); }
void corotational(benchmark::State& state) { moved_patch(state, Model::kCorotational); }
void neo_hookean(benchmark::State& state) { moved_patch(state, Model::kNeoHookean); }

// Steps of 10 ms of a body, held where `anchor` says.
void dynamic_steps(benchmark::State& state, tissue::Body body, const std::string& model,
                   const std::string& anchor, const std::string& effects) {
  const PeakMemory memory;
  const bool by_density = effects.find("density_response") != std::string::npos;
  const std::string young = by_density ? "[[1, 50e3], [2, 5e6]]" : "[[1, 50e3]]";
  tissue::Scene scene(
      tissue::parse_scene(model + "material: {young: " + young + ", poisson: 0.45}\nanchors: [" +
                          anchor + "]\neffects: [" + effects + "]\n"),
      std::make_shared<tissue::Body>(std::move(body)));
  measure(state, scene, memory, [&] { return scene.step(tissue::ToolPoses{}, 0.01); });
}

const char kClampedEnd[] = "{plane: {axis: x, below: 0.001}}";
const char kFalling[] = "density_response, gravity, inertia, {damping: {mass: 5}}";

tissue::Body beam_body(int across, int halvings) {
  return tissue_test::kuhn_block({2 * across, across, across}, {0.2, 0.1, 0.1}, halvings);
}

// One linearised step of implicit Euler: a clamped beam that starts to sag, mean over its first
// hundred steps. Arguments as above; with an inclusion a hundred times as stiff or without; how
// often the mesh was halved to become as fine as it is.
void implicit_step(benchmark::State& state) {
  tissue::Body body = beam_body(static_cast<int>(state.range(0)), static_cast<int>(state.range(3)));
  if (state.range(2) != 0) {
    body = tissue_test::with_core(std::move(body), {0.1, 0.05, 0.05}, 0.03, 2.0f, 1.0f);
  }
  dynamic_steps(state, std::move(body),
                "model: corotational\nelement_order: " + std::to_string(state.range(1)) + "\n",
                kClampedEnd, kFalling);
}

// The same for an organ of 60 mm refined by density around a tumour a hundred times as stiff.
void implicit_organ(benchmark::State& state) {
  tissue::Body body = tissue_test::ball_body(tissue_test::refined_ball(0.0063), 0.01, 2.0f, 1.0f);
  dynamic_steps(state, std::move(body), "model: corotational\n", "{plane: {axis: z, below: -0.02}}",
                kFalling);
}

// A finger that presses on a ball with a tumour ten thousand times as stiff as the tissue around
// it, or rigid. Arguments: whether it is rigid, order of the elements, whether there is inertia.
void tumour(benchmark::State& state) {
  const bool is_rigid = state.range(0) != 0, swings = state.range(2) != 0;
  static const auto body = std::make_shared<tissue::Body>(
      tissue_test::ball_body(tissue_test::refined_ball(0.014), 0.01, 255.0f, 60.0f));
  const PeakMemory memory;
  tissue::Scene scene(
      tissue::parse_scene("model: corotational\nelement_order: " + std::to_string(state.range(1)) +
                          "\nmaterial: {young: [[199, 3e3], [201, 3e7]], poisson: 0.45}\n"
                          "anchors: [{plane: {axis: z, below: 12%}}]\n"
                          "tools: [{name: finger, shape: {pad: {radius: 0.02}}, mode: grasp}]\n"
                          "effects: [density_response" +
                          std::string(is_rigid ? ", rigid_inclusions" : "") +
                          (swings ? ", inertia, damping]\n" : "]\n")),
      body);
  int i = 0;
  measure(state, scene, memory, [&] {
    const tissue::Vec3 place(0.01 + 0.0005 * (i % 8), 0.002, 0.03 - 0.0005 * (i % 8));
    ++i;
    return scene.step(tissue::ToolPose{place, true}, 0.02);
  });
}

// What each effect adds to a step of a beam of 20,736 tets.
void effects(benchmark::State& state, const std::string& names) {
  dynamic_steps(state, beam_body(12, 2), "model: corotational\n", kClampedEnd, names);
}

// 1,377 to 18,081 vertices; 6,144 to 96,000 tets.
BENCHMARK(implicit_step)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(100)
    ->ArgsProduct({{8, 12, 20}, {1}, {0, 1}, {2, 0}})
    ->Args({4, 2, 0, 2})
    ->Args({8, 2, 0, 2})
    ->Args({8, 2, 1, 2})
    ->Args({8, 2, 0, 0})
    ->Args({16, 2, 0, 2});
BENCHMARK(tumour)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(8)
    ->ArgsProduct({{0, 1}, {1}, {0, 1}})
    ->ArgsProduct({{0, 1}, {2}, {0}});
BENCHMARK(implicit_organ)->Unit(benchmark::kMillisecond)->Iterations(30);
BENCHMARK_CAPTURE(effects, inertia, std::string("inertia"))
    ->Unit(benchmark::kMillisecond)
    ->Iterations(50);
BENCHMARK_CAPTURE(effects, and_gravity, std::string("inertia, gravity"))
    ->Unit(benchmark::kMillisecond)
    ->Iterations(50);
BENCHMARK_CAPTURE(effects, and_density_response, std::string("inertia, gravity, density_response"))
    ->Unit(benchmark::kMillisecond)
    ->Iterations(50);
BENCHMARK_CAPTURE(effects, and_damping,
                  std::string("inertia, gravity, density_response, {damping: {mass: 5}}"))
    ->Unit(benchmark::kMillisecond)
    ->Iterations(50);
BENCHMARK_CAPTURE(effects, and_stiffness_damping,
                  std::string("inertia, gravity, density_response, "
                              "{damping: {mass: 5, stiffness: 0.001}}"))
    ->Unit(benchmark::kMillisecond)
    ->Iterations(50);
BENCHMARK(closed_form)->Args({8, 1})->Args({12, 1})->Args({20, 1})->Args({32, 1});
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
