// Replaces operator new and delete in the programs that are linked with this file, so that they can
// report how much memory their containers really took. Programs without it lose only that figure,
// as do those that a sanitizer watches: it has its own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include "memory_counters.h"

#include <malloc.h>

#include <cstdlib>
#include <new>

namespace {

void count(void* block) {
  tissue::MemoryCounters& counters = tissue::memory_counters();
  const std::size_t bytes = malloc_usable_size(block);
  const std::size_t now = counters.now.fetch_add(bytes, std::memory_order_relaxed) + bytes;
  std::size_t peak = counters.peak.load(std::memory_order_relaxed);
  while (now > peak && !counters.peak.compare_exchange_weak(peak, now, std::memory_order_relaxed)) {
  }
}

void* allocate(std::size_t size) {
  void* block = std::malloc(size > 0 ? size : 1);
  if (block == nullptr) throw std::bad_alloc();
  count(block);
  return block;
}

void* allocate(std::size_t size, std::align_val_t alignment) {
  void* block = nullptr;
  if (posix_memalign(&block, static_cast<std::size_t>(alignment), size > 0 ? size : 1) != 0) {
    throw std::bad_alloc();
  }
  count(block);
  return block;
}

void release(void* block) {
  if (block == nullptr) return;
  tissue::memory_counters().now.fetch_sub(malloc_usable_size(block), std::memory_order_relaxed);
  std::free(block);
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, alignment);
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return allocate(size, alignment);
}
void operator delete(void* block) noexcept { release(block); }
void operator delete[](void* block) noexcept { release(block); }
void operator delete(void* block, std::size_t) noexcept { release(block); }
void operator delete[](void* block, std::size_t) noexcept { release(block); }
void operator delete(void* block, std::align_val_t) noexcept { release(block); }
void operator delete[](void* block, std::align_val_t) noexcept { release(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { release(block); }
void operator delete[](void* block, std::size_t, std::align_val_t) noexcept { release(block); }

#endif
