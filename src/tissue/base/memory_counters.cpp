#include "memory_counters.h"

namespace tissue {

MemoryCounters& memory_counters() {
  static MemoryCounters counters;
  return counters;
}

}  // namespace tissue
