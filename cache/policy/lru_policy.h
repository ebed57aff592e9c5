#pragma once

#include <cstdint>

#include "cache/policy/frame_states.h"
#include "cache/policy/policy_tables.h"
#include "cache/policy/recency_heap.h"

namespace planetree::cache {

/// Chooses the page to evict: the least recently used one. See RecencyHeap for what that is.
class LruPolicy {
 public:
  explicit LruPolicy(const PolicyTables& tables) noexcept
      : by_use_(tables.now, tables.uses, tables.entries) {}

  ReferenceBits reference_bits() const noexcept { return by_use_.reference_bits(); }

  void install(std::uint32_t frame, std::uint32_t /*page*/, PageTier /*tier*/) noexcept {
    by_use_.use_now(frame);
    by_use_.add(frame);
  }
  void remove(std::uint32_t /*frame*/) noexcept {}
  void release(std::uint32_t frame) noexcept { by_use_.add(frame); }
  std::uint32_t choose_victim(const FrameStates& states) noexcept {
    return by_use_.least_recent(
        [&states](std::uint32_t frame) { return states.is_evictable(frame); });
  }

 private:
  RecencyHeap by_use_;
};

}  // namespace planetree::cache
