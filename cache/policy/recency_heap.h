#pragma once

#include <cstdint>
#include <span>

#include "cache/policy/frame_states.h"
#include "cache/policy/reference_bits.h"

namespace planetree::cache {

/// Frames in the order of their last use.
///
/// Time is the number of pages installed so far. It does not change while all pages requested are
/// resident, so its cache line then stays in every processor's cache. Uses between two installs
/// count as equally old; of these the lowest frame comes first. Readers store the time in the
/// frames that they use. The writer keeps the frames in a heap, ordered by the last use that it has
/// read. It reads the last use of the top frame again and moves the frame down if readers have used
/// it since.
///
/// A view of memory that PageCache owns.
class RecencyHeap {
 public:
  struct Entry {
    std::uint64_t last_use;  ///< last use of this frame that the writer has read
    std::uint32_t heap;      ///< frame at this position of the heap
    bool in_heap;            ///< whether this frame is in the heap
  };

  /// `now` has one time, on a cache line of its own. `uses` and `entries` have one element per
  /// frame. All are 0.
  RecencyHeap(std::span<UseTime> now, std::span<UseTime> uses, std::span<Entry> entries) noexcept
      : now_(now), uses_(uses), entries_(entries) {}

  ReferenceBits reference_bits() const noexcept {
    return ReferenceBits::timing(uses_.data(), now_.data());
  }

  /// Advances the time and marks the frame as used now.
  void use_now(std::uint32_t frame) noexcept;

  /// Adds a frame. It may still be in the heap from before, with a use that is too old.
  void add(std::uint32_t frame) noexcept;

  /// Returns the least recently used frame for which accepts(frame) is true, or kNoFrame. Frames
  /// that are not accepted leave the heap. The frame returned stays in it.
  template <class Accepts>
  std::uint32_t least_recent(const Accepts& accepts) noexcept {
    // The loop ends because time does not advance during the call: each frame is corrected at most
    // once.
    while (size_ > 0) {
      const std::uint32_t frame = entries_[0].heap;
      const std::uint64_t use = uses_[frame].load(std::memory_order_relaxed);
      if (!accepts(frame)) {
        pop();
      } else if (use > entries_[frame].last_use) {
        entries_[frame].last_use = use;
        sink();
      } else {
        return frame;
      }
    }
    return kNoFrame;
  }

 private:
  void pop() noexcept;
  void sink() noexcept;
  bool is_before(std::uint32_t frame, std::uint32_t other) const noexcept;

  std::span<UseTime> now_;
  std::span<UseTime> uses_;
  std::span<Entry> entries_;
  std::uint32_t size_ = 0;  // frames in the heap
};

}  // namespace planetree::cache
