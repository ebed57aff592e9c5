#pragma once

#include <cstdint>
#include <span>

#include "cache/policy/frame_list.h"
#include "cache/policy/frame_states.h"
#include "cache/policy/ghost_list.h"
#include "cache/policy/policy_tables.h"
#include "cache/policy/reference_bits.h"

namespace planetree::cache {

/// Chooses the page to evict: S3-FIFO.
///
/// A new page enters the small queue, which has a tenth of the frames. Once it is the oldest there,
/// it moves to the main queue if it was used more than once, and is evicted otherwise. An evicted
/// page stays in a ghost list as long as the main queue. A page that returns while it is in the
/// list enters the main queue. There, the oldest page goes back to the newest end as often as it
/// was used, at most kMaxUses times, and is evicted then.
///
/// source  Yang et al. 2023, "FIFO queues are all you need for cache eviction", algorithm 1.
///
/// A view of memory that PageCache owns.
class S3FifoPolicy {
 public:
  static constexpr std::uint8_t kMaxUses = 3;
  /// More uses than this move a page from the small to the main queue.
  static constexpr std::uint8_t kUsesToStay = 1;
  static constexpr std::uint32_t kSmallShare = 10;  ///< the small queue has a tenth of the frames

  explicit S3FifoPolicy(const PolicyTables& tables) noexcept;

  ReferenceBits reference_bits() const noexcept {
    return ReferenceBits::counting(uses_.data(), 1, kMaxUses - 1);
  }

  void install(std::uint32_t frame, std::uint32_t page, PageTier tier) noexcept;
  void remove(std::uint32_t frame) noexcept;
  void release(std::uint32_t /*frame*/) noexcept {}
  std::uint32_t choose_victim(const FrameStates& states) noexcept;

 private:
  std::uint32_t victim_in_small(const FrameStates& states) noexcept;
  std::uint32_t victim_in_main(const FrameStates& states) noexcept;
  void add_to_main(std::uint32_t frame) noexcept {
    nodes_[frame].in_main = true;
    main_.add_newest(frame);
  }

  std::span<UseCount> uses_;
  std::span<FrameNode> nodes_;
  FrameList small_, main_;
  const std::uint32_t small_capacity_, main_capacity_;
  GhostList ghosts_;
};

}  // namespace planetree::cache
