#include "tissue/base/stage_clock.h"

#include "memory_counters.h"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace tissue {
namespace {

double wall_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double cpu_now() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

MemoryUse memory_use() {
  return {memory_counters().now.load(std::memory_order_relaxed),
          memory_counters().peak.load(std::memory_order_relaxed)};
}

void reset_memory_peak() { memory_counters().peak.store(memory_counters().now.load()); }

StageClock::StageClock() : bytes_at_start_(memory_use().now) {}

void StageClock::start(const std::string& name) {
  stop();
  current_ = 0;
  while (current_ < stages_.size() && stages_[current_].name != name) ++current_;
  if (current_ == stages_.size()) stages_.push_back({name, 0.0, 0.0, 0});
  reset_memory_peak();
  cpu_at_start_ = cpu_now();
  wall_at_start_ = wall_now();
  running_ = true;
}

void StageClock::stop() {
  if (!running_) return;
  StageCost& stage = stages_[current_];
  stage.cpu_seconds += cpu_now() - cpu_at_start_;
  stage.wall_seconds += wall_now() - wall_at_start_;
  const std::size_t peak = memory_use().peak;
  stage.peak_bytes = std::max(stage.peak_bytes, peak - std::min(peak, bytes_at_start_));
  running_ = false;
}

std::size_t StageClock::peak_bytes() const {
  std::size_t peak = 0;
  for (const StageCost& stage : stages_) peak = std::max(peak, stage.peak_bytes);
  return peak;
}

}  // namespace tissue
