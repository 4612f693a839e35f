// One program for all targets: the environment variable TISSUE_FUZZ_TARGET says which
// (scripts/fuzz).
#include "fuzz/targets.h"
#include "tissue/base/error.h"

#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const tissue_fuzz::Target target = [] {
    const char* const name = std::getenv("TISSUE_FUZZ_TARGET");
    const auto found = tissue_fuzz::targets().find(name != nullptr ? name : "");
    if (found == tissue_fuzz::targets().end()) {
      std::fprintf(stderr, "fuzz: TISSUE_FUZZ_TARGET names no target\n");
      std::exit(2);
    }
    return found->second;
  }();
  try {
    target(data, size);
  } catch (const tissue::InputError&) {
  }
  return 0;
}
