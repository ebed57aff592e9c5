#include "tests/query/lock_count.h"

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>

#include "tests/cache/allocation_count.h"

namespace {

thread_local std::uint64_t locks_taken = 0;

}  // namespace

namespace planetree::query {

bool locks_are_counted() noexcept { return cache::allocations_are_counted(); }

std::uint64_t lock_count() noexcept { return locks_taken; }

}  // namespace planetree::query

#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
#define PLANETREE_COUNTS_LOCKS 0
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer) || __has_feature(address_sanitizer) || \
    __has_feature(memory_sanitizer)
#define PLANETREE_COUNTS_LOCKS 0
#endif
#endif

#ifndef PLANETREE_COUNTS_LOCKS
// Interposes the system's function and calls it.
extern "C" [[gnu::visibility("default")]] int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  using Lock = int (*)(pthread_mutex_t*);
  static std::atomic<Lock> next{nullptr};
  Lock lock = next.load(std::memory_order_relaxed);
  if (lock == nullptr) {
    lock = reinterpret_cast<Lock>(::dlsym(RTLD_NEXT, "pthread_mutex_lock"));
    next.store(lock, std::memory_order_relaxed);
  }
  ++locks_taken;
  return lock(mutex);
}
#endif
