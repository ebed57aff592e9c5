#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "cache/frame_pool.h"
#include "cache/frame_states.h"

namespace planetree::cache {

/// Chooses the page to evict: the least recently used one.
///
/// Time is the number of pages installed so far. It does not change while all pages requested are
/// resident, so its cache line then stays in every processor's cache. Uses between two installs
/// count as equally old. Readers store the time in the frames that they use. The writer keeps the
/// frames in a heap, ordered by the last use that it has read. It reads the last use of the top
/// frame again and moves the frame down if readers have used it since.
///
/// A view of memory that PageCache owns. Readers may call mark() only.
class LruPolicy {
 public:
  using Tick = std::atomic<std::uint64_t>;
  struct Entry {
    std::uint64_t last_use;  ///< last use of this frame that the writer has read
    std::uint32_t heap;      ///< frame at this position of the heap
    bool in_heap;            ///< whether this frame is in the heap
  };

  /// `now` has one tick, on a cache line of its own. `uses` and `entries` have one element per
  /// frame. All are 0.
  LruPolicy(std::span<Tick> now, std::span<Tick> uses, std::span<Entry> entries) noexcept
      : now_(now), uses_(uses), entries_(entries) {}

  /// Records a use of a frame. Relaxed, for the reasons given at ClockPolicy::mark().
  static void mark(Tick& use, const Tick& now) noexcept {
    const std::uint64_t time = now.load(std::memory_order_relaxed);
    if (use.load(std::memory_order_relaxed) != time) use.store(time, std::memory_order_relaxed);
  }

  void install(std::uint32_t frame) noexcept;
  /// Adds a frame that has become evictable again.
  void release(std::uint32_t frame) noexcept { push(frame); }

  /// Returns an evictable frame, or kNoFrame if there is none.
  std::uint32_t choose_victim(const FrameStates& states) noexcept;

 private:
  void push(std::uint32_t frame) noexcept;
  void pop() noexcept;
  void sink() noexcept;
  bool is_before(std::uint32_t frame, std::uint32_t other) const noexcept;

  std::span<Tick> now_;
  std::span<Tick> uses_;
  std::span<Entry> entries_;
  std::uint32_t size_ = 0;  // frames in the heap
};

static_assert(LruPolicy::Tick::is_always_lock_free);

}  // namespace planetree::cache
