#include "tissue/base/machine_memory.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace tissue {
namespace {

constexpr std::size_t kUnknown = std::numeric_limits<std::size_t>::max();

std::size_t system_has() {
  std::ifstream file("/proc/meminfo");
  std::string key;
  std::size_t kilobytes = 0;
  while (file >> key >> kilobytes) {
    if (key == "MemAvailable:") return kilobytes * 1024;
    file.ignore(256, '\n');
  }
  return kUnknown;
}

struct OwnMemory {
  std::size_t all = 0, resident = 0;
};

OwnMemory own_memory() {
  std::ifstream file("/proc/self/statm");
  OwnMemory pages;
  file >> pages.all >> pages.resident;
  const auto size = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return {pages.all * size, pages.resident * size};
}

std::size_t limit_leaves() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnknown;
  const std::size_t used = own_memory().all;
  return limit.rlim_cur - std::min<std::size_t>(limit.rlim_cur, used);
}

}  // namespace

std::size_t available_memory() { return std::min(system_has(), limit_leaves()); }

std::size_t resident_memory() { return own_memory().resident; }

std::size_t allocated_memory() {
#if defined(__GLIBC_PREREQ)
#if __GLIBC_PREREQ(2, 33)
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
#endif
#endif
  return 0;
}

}  // namespace tissue
