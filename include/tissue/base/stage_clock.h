#pragma once

#include "tissue/base/mesh_statistics.h"

#include <string>
#include <vector>

namespace tissue {

/// Bytes held now, and the most held since the last reset, by what operator new gave out. Both are
/// 0 in a program that is not linked with the memory meter (src/tissue/base/memory_meter.cpp).
struct MemoryUse {
  std::size_t now = 0;
  std::size_t peak = 0;
};
MemoryUse memory_use();
void reset_memory_peak();

/// Measures the stages of a run, one after the other.
class StageClock {
 public:
  StageClock();
  /// Ends the stage that runs, if any, and starts another, or goes on with an earlier one of that
  /// name.
  void start(const std::string& name);
  /// Ends the stage that runs.
  void stop();
  const std::vector<StageCost>& stages() const { return stages_; }
  /// The largest of the stages' peaks.
  std::size_t peak_bytes() const;

 private:
  std::vector<StageCost> stages_;
  std::size_t current_ = 0;
  std::size_t bytes_at_start_;
  double cpu_at_start_ = 0.0;
  double wall_at_start_ = 0.0;
  bool running_ = false;
};

}  // namespace tissue
