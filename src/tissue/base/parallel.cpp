#include "tissue/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace tissue {

void parallel_ranges(std::size_t count, std::size_t grain, const Run& run,
                     const std::function<void(std::size_t begin, std::size_t end)>& body) {
  if (run.threads == 1 || count <= grain) {
    for (std::size_t begin = 0; begin < count; begin += grain) {
      run.go_on();
      body(begin, std::min(begin + grain, count));
    }
    return;
  }
  tbb::task_arena arena(run.threads > 0 ? run.threads
                                        : static_cast<int>(tbb::task_arena::automatic));
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) {
      run.go_on();
      body(range.begin(), range.end());
    });
  });
}

}  // namespace tissue
