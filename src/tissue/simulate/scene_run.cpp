#include "tissue/simulate/scene_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace tissue {

void RunRecord::add(const StepReport& step, double wall_seconds) {
  last = step;
  seconds.push_back(wall_seconds);
  not_converged += step.not_converged;
  clamped = clamped || step.clamped;
  folded = folded || step.folded;
  tool_inside = tool_inside || step.tool_inside;
  penetration = std::max(penetration, step.penetration);
}

RunRecord run_along(Scene& scene, const std::vector<Instant>& instants,
                    const std::function<void(std::size_t done)>& after_step) {
  RunRecord record;
  for (std::size_t i = 0; i < instants.size(); ++i) {
    const double dt = i == 0 ? 0.0 : instants[i].time - instants[i - 1].time;
    const auto start = std::chrono::steady_clock::now();
    const StepReport report = scene.step(instants[i].tools, dt);
    record.add(report,
               std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    if (after_step) after_step(i + 1);
  }
  return record;
}

double percentile(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return values[static_cast<std::size_t>(std::ceil(part * last))];
}

}  // namespace tissue
