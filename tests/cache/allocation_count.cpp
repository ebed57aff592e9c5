#include "tests/cache/allocation_count.h"

#include <atomic>
#include <cstdlib>
#include <new>

#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
#define PLANETREE_COUNTS_ALLOCATIONS 0
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer) || __has_feature(address_sanitizer) || \
    __has_feature(memory_sanitizer)
#define PLANETREE_COUNTS_ALLOCATIONS 0
#endif
#endif
#ifndef PLANETREE_COUNTS_ALLOCATIONS
#define PLANETREE_COUNTS_ALLOCATIONS 1
#endif

namespace {

std::atomic<std::uint64_t> count{0};
thread_local std::uint64_t thread_count = 0;

#if PLANETREE_COUNTS_ALLOCATIONS
void* allocate(std::size_t bytes, std::size_t alignment) noexcept {
  count.fetch_add(1, std::memory_order_relaxed);
  ++thread_count;
  // aligned_alloc requires a multiple of the alignment, and not 0.
  const std::size_t rounded = (bytes / alignment + 1) * alignment;
  return std::aligned_alloc(alignment, rounded);
}

void* allocate_or_throw(std::size_t bytes, std::size_t alignment) {
  void* memory = allocate(bytes, alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

constexpr std::size_t kUsual = __STDCPP_DEFAULT_NEW_ALIGNMENT__;
#endif

}  // namespace

namespace planetree::cache {

bool allocations_are_counted() noexcept { return PLANETREE_COUNTS_ALLOCATIONS != 0; }

std::uint64_t allocation_count() noexcept { return count.load(std::memory_order_relaxed); }

std::uint64_t thread_allocation_count() noexcept { return thread_count; }

}  // namespace planetree::cache

#if PLANETREE_COUNTS_ALLOCATIONS
// The array and nothrow forms of the standard library call these.
void* operator new(std::size_t bytes) { return allocate_or_throw(bytes, kUsual); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocate_or_throw(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
#endif
