#pragma once

#include <cstdint>
#include <span>

#include "cache/policy/frame_list.h"
#include "cache/policy/frame_states.h"
#include "cache/policy/ghost_list.h"
#include "cache/policy/policy_tables.h"
#include "cache/policy/recency_heap.h"
#include "cache/policy/reference_bits.h"

namespace planetree::cache {

/// Chooses the page to evict: 2Q.
///
/// A new page enters a queue, A1in in the paper. While the queue has more than a quarter of the
/// frames, its oldest page is evicted, however often it was used, and enters a ghost list of half
/// as many pages as there are frames, A1out. A page that returns while it is in the list is a main
/// page, Am. If the queue is short, the least recently used main page is evicted.
///
/// The paper looks a page up in A1out before it evicts another one, this class afterwards.
///
/// source  Johnson & Shasha 1994, "2Q: a low overhead high performance buffer management
/// replacement
///         algorithm", the full version.
///
/// A view of memory that PageCache owns.
class TwoQPolicy {
 public:
  static constexpr std::uint32_t kQueueShare = 4;  ///< the queue has a quarter of the frames
  static constexpr std::uint32_t kGhostShare = 2;  ///< ghosts are half as many as the frames

  explicit TwoQPolicy(const PolicyTables& tables) noexcept;

  ReferenceBits reference_bits() const noexcept { return main_.reference_bits(); }

  void install(std::uint32_t frame, std::uint32_t page, PageTier tier) noexcept;
  void remove(std::uint32_t frame) noexcept;
  void release(std::uint32_t frame) noexcept {
    if (nodes_[frame].in_main) main_.add(frame);
  }
  std::uint32_t choose_victim(const FrameStates& states) noexcept;

 private:
  std::uint32_t victim_in_queue(const FrameStates& states) const noexcept;
  std::uint32_t victim_in_main(const FrameStates& states) noexcept;

  std::span<FrameNode> nodes_;
  FrameList queue_;
  RecencyHeap main_;
  const std::uint32_t queue_capacity_;
  GhostList ghosts_;
};

}  // namespace planetree::cache
