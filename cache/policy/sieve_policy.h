#pragma once

#include <cstdint>
#include <span>

#include "cache/policy/frame_list.h"
#include "cache/policy/frame_states.h"
#include "cache/policy/policy_tables.h"
#include "cache/policy/reference_bits.h"

namespace planetree::cache {

/// Chooses the page to evict: SIEVE.
///
/// The frames are in a queue, in the order in which their pages were installed. A hand passes from
/// the oldest to the newest frame, and then begins at the oldest again. It clears the mark of each
/// used frame that it passes and stops at the first frame without a mark. A used frame keeps its
/// place.
///
/// source  Zhang et al. 2024, "SIEVE is simpler than LRU: an efficient turn-key eviction algorithm
///         for web caches", algorithm 1.
///
/// A view of memory that PageCache owns.
class SievePolicy {
 public:
  explicit SievePolicy(const PolicyTables& tables) noexcept
      : used_(tables.counts), queue_(tables.nodes) {}

  ReferenceBits reference_bits() const noexcept {
    return ReferenceBits::counting(used_.data(), 1, 0);
  }

  void install(std::uint32_t frame, std::uint32_t /*page*/, PageTier /*tier*/) noexcept {
    used_[frame].store(0, std::memory_order_relaxed);
    queue_.add_newest(frame);
  }
  void remove(std::uint32_t frame) noexcept {
    if (hand_ == frame) hand_ = queue_.newer(frame);
    queue_.erase(frame);
  }
  void release(std::uint32_t /*frame*/) noexcept {}
  std::uint32_t choose_victim(const FrameStates& states) noexcept;

 private:
  std::span<UseCount> used_;  // 0 or 1
  FrameList queue_;
  std::uint32_t hand_ = kNoFrame;  // next frame to look at; kNoFrame: the oldest
};

}  // namespace planetree::cache
