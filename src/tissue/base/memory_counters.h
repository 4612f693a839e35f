#pragma once

#include <atomic>
#include <cstddef>

namespace tissue {

/// What memory_meter.cpp counts and stage_clock.cpp reads.
struct MemoryCounters {
  std::atomic<std::size_t> now{0};
  std::atomic<std::size_t> peak{0};
};

MemoryCounters& memory_counters();

}  // namespace tissue
