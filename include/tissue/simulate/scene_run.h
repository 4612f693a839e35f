#pragma once

#include "tissue/simulate/pose_path.h"

#include <functional>

namespace tissue {

/// What the steps of a run cost and how they went.
struct RunRecord {
  /// Wall clock, of every step.
  std::vector<double> seconds;
  std::size_t not_converged = 0;
  bool clamped = false, folded = false, tool_inside = false;
  /// Deepest of all steps [m].
  double penetration = 0.0;
  /// Of the last step.
  StepReport last;

  void add(const StepReport& step, double wall_seconds);
};

/// Lets a scene go through the instants, in order; `after_step`, if there is any, hears how many
/// are done.
RunRecord run_along(Scene& scene, const std::vector<Instant>& instants,
                    const std::function<void(std::size_t done)>& after_step = {});

/// The value below which this part of the others lie: 0.5 is the median. `values` must not be
/// empty.
double percentile(std::vector<double> values, double part);

}  // namespace tissue
