#pragma once

#include <cstddef>
#include <functional>

namespace tissue {

/// Calls `body(begin, end)` for pieces of [0, count) on at most `threads` threads; 0 means all that
/// the machine has. Pieces may run in any order: each must write only what is its own, so that the
/// result is the same for any number of threads.
void parallel_ranges(std::size_t count, int threads,
                     const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace tissue
