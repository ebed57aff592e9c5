#pragma once

#include <atomic>
#include <cstdint>

namespace planetree::cache {

/// Counts of uses of a frame. A policy chooses the step and the limit.
using UseCount = std::atomic<std::uint8_t>;
/// Time of the last use of a frame. Time is a count of the writer, see RecencyHeap.
using UseTime = std::atomic<std::uint64_t>;

static_assert(UseCount::is_always_lock_free && UseTime::is_always_lock_free);

/// Lets readers mark the use of a frame under any policy, without a virtual call. A policy either
/// counts uses or keeps the time of the last one.
///
/// All accesses are relaxed, and a store may be lost in a race with the writer or another reader: a
/// mark is only a guess about the future, and a reader's section, not the mark, protects the frame
/// it reads. Nothing is stored if the mark would stay the same, so that the marks of hot frames
/// stay in every processor's cache.
///
/// A view of memory that PageCache owns.
class ReferenceBits {
 public:
  /// Bit of a UseCount that marking leaves alone. A policy may keep a property of the page there.
  static constexpr std::uint8_t kReservedBit = 0x80;

  /// Uses are counted: each adds `step` while the count is at most `max_before`.
  static ReferenceBits counting(UseCount* counts, std::uint8_t step,
                                std::uint8_t max_before) noexcept {
    ReferenceBits bits;
    bits.counts_ = counts;
    bits.step_ = step;
    bits.max_before_ = max_before;
    return bits;
  }
  /// Each use stores the time, *now.
  static ReferenceBits timing(UseTime* times, const UseTime* now) noexcept {
    ReferenceBits bits;
    bits.times_ = times;
    bits.now_ = now;
    return bits;
  }

  void mark(std::uint32_t frame) const noexcept {
    if (counts_ != nullptr) {
      UseCount& count = counts_[frame];
      const std::uint8_t before = count.load(std::memory_order_relaxed);
      if ((before & ~kReservedBit) <= max_before_)
        count.store(static_cast<std::uint8_t>(before + step_), std::memory_order_relaxed);
    } else {
      UseTime& time = times_[frame];
      const std::uint64_t now = now_->load(std::memory_order_relaxed);
      if (time.load(std::memory_order_relaxed) != now) time.store(now, std::memory_order_relaxed);
    }
  }

 private:
  UseCount* counts_ = nullptr;
  std::uint8_t step_ = 0;
  std::uint8_t max_before_ = 0;
  UseTime* times_ = nullptr;
  const UseTime* now_ = nullptr;
};

}  // namespace planetree::cache
