#include "tissue/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace tissue {

void parallel_ranges(std::size_t count, int threads,
                     const std::function<void(std::size_t begin, std::size_t end)>& body) {
  constexpr std::size_t kGrain = 512;
  if (threads == 1 || count <= kGrain) {
    body(0, count);
    return;
  }
  tbb::task_arena arena(threads > 0 ? threads : static_cast<int>(tbb::task_arena::automatic));
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain),
                      [&](const auto& range) { body(range.begin(), range.end()); });
  });
}

}  // namespace tissue
