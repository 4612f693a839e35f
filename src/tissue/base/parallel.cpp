#include "tissue/base/parallel.h"

#ifdef __SANITIZE_THREAD__
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>
#else
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

#include <algorithm>

namespace tissue {
namespace {

using Piece = std::function<void(std::size_t begin, std::size_t end)>;

#ifdef __SANITIZE_THREAD__
// ThreadSanitizer does not see what TBB's library synchronises, and takes it for races; it sees all
// that plain threads do.
void on_threads(std::size_t count, std::size_t grain, int threads, const Piece& body) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failing;
  const auto work = [&] {
    for (;;) {
      // Relaxed: one piece is not to wait for what another has written.
      const std::size_t begin = next.fetch_add(grain, std::memory_order_relaxed);
      if (begin >= count) return;
      try {
        body(begin, std::min(begin + grain, count));
      } catch (...) {
        const std::lock_guard<std::mutex> lock(failing);
        failure = std::current_exception();
        next.store(count, std::memory_order_relaxed);
      }
    }
  };
  std::vector<std::thread> others;
  for (int i = 1; i < (threads > 0 ? threads : 2); ++i) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  if (failure) std::rethrow_exception(failure);
}
#else
void on_threads(std::size_t count, std::size_t grain, int threads, const Piece& body) {
  tbb::task_arena arena(threads > 0 ? threads : static_cast<int>(tbb::task_arena::automatic));
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [&](const auto& range) { body(range.begin(), range.end()); });
  });
}
#endif

}  // namespace

void parallel_ranges(std::size_t count, std::size_t grain, const Run& run, const Piece& body) {
  const auto piece = [&](std::size_t begin, std::size_t end) {
    run.go_on();
    body(begin, end);
  };
  if (run.threads != 1 && count > grain) return on_threads(count, grain, run.threads, piece);
  for (std::size_t begin = 0; begin < count; begin += grain) {
    piece(begin, std::min(begin + grain, count));
  }
}

}  // namespace tissue
