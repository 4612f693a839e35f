#include "tissue/simulate/scene_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace tissue {

RunRecord run_along(Scene& scene, const std::vector<Instant>& instants,
                    const std::function<void(std::size_t done)>& after_step) {
  RunRecord record;
  for (std::size_t i = 0; i < instants.size(); ++i) {
    const double dt = i == 0 ? 0.0 : instants[i].time - instants[i - 1].time;
    const auto start = std::chrono::steady_clock::now();
    record.last = scene.step(instants[i].tools, dt);
    record.seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    record.not_converged += record.last.not_converged;
    record.clamped = record.clamped || record.last.clamped;
    record.tool_inside = record.tool_inside || record.last.tool_inside;
    record.penetration = std::max(record.penetration, record.last.penetration);
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
