#pragma once

#include "tissue/base/run.h"

#include <cstddef>
#include <functional>

namespace tissue {

/// Calls `body(begin, end)` for pieces of [0, count), of `grain` or a little more, on the threads
/// of the run. Pieces may run in any order: each must write only what is its own, so that the
/// result is the same for any number of threads. Throws InputError E_CANCELLED between pieces.
void parallel_ranges(std::size_t count, std::size_t grain, const Run& run,
                     const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace tissue
