#pragma once

#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace tissue {

/// By how much the program's resident memory has been above what it was when this was made, at
/// most.
class PeakMemory {
 public:
  PeakMemory() {
    malloc_trim(0);
    // Forgets the highest so far (proc(5)).
    std::ofstream("/proc/self/clear_refs") << "5";
    before_ = bytes("VmRSS:");
  }
  double bytes() const { return std::max(0.0, bytes("VmHWM:") - before_); }

 private:
  static double bytes(const std::string& name) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
      double kilobytes = 0.0;
      if (word == name && status >> kilobytes) return 1024.0 * kilobytes;
    }
    return 0.0;
  }
  double before_;
};

}  // namespace tissue
