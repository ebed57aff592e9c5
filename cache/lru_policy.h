#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "cache/frame_pool.h"
#include "cache/frame_states.h"

namespace planetree::cache {

/// Which page has to go: the one that was used longest ago.
///
/// Time is the number of pages installed so far, so that it stands still, in every processor's
/// cache, while all that is asked for is resident; uses between two installs are equally long
/// ago. Readers store it in the frames that they use. The writer keeps the frames in a heap by
/// the last use it knows of, and looks a frame's up again when it comes to the top: a frame used
/// since goes down to its place.
///
/// A view of memory that PageCache owns. Only mark() may be called by readers.
class LruPolicy {
 public:
  using Tick = std::atomic<std::uint64_t>;
  struct Entry {
    std::uint64_t known;  ///< last use
    std::uint32_t heap;   ///< the frame at this place of the heap
    bool in_heap;
  };

  /// `now` is one tick, on a cache line of its own; the others have one element per frame. All 0.
  LruPolicy(std::span<Tick> now, std::span<Tick> uses, std::span<Entry> entries) noexcept
      : now_(now), uses_(uses), entries_(entries) {}

  /// Says that a frame was used. Relaxed: see ClockPolicy::mark().
  static void mark(Tick& use, const Tick& now) noexcept {
    const std::uint64_t time = now.load(std::memory_order_relaxed);
    if (use.load(std::memory_order_relaxed) != time) use.store(time, std::memory_order_relaxed);
  }

  void install(std::uint32_t frame) noexcept;
  /// A frame has become evictable again.
  void release(std::uint32_t frame) noexcept { push(frame); }

  /// An evictable frame; kNoFrame if there is none.
  std::uint32_t choose_victim(const FrameStates& states) noexcept;

 private:
  void push(std::uint32_t frame) noexcept;
  void pop() noexcept;
  void sink() noexcept;
  bool is_before(std::uint32_t frame, std::uint32_t other) const noexcept;

  std::span<Tick> now_;
  std::span<Tick> uses_;
  std::span<Entry> entries_;
  std::uint32_t size_ = 0;  // of the heap
};

static_assert(LruPolicy::Tick::is_always_lock_free);

}  // namespace planetree::cache
