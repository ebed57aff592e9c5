#pragma once

#include <cstdint>
#include <span>

#include "cache/cache_limits.h"
#include "cache/clock_policy.h"
#include "cache/frame_states.h"
#include "cache/lru_policy.h"

namespace planetree::cache {

/// Lets readers record the use of a frame under either policy, without a virtual call.
class ReferenceBits {
 public:
  ReferenceBits(ClockPolicy::Score* scores, LruPolicy::Tick* uses,
                const LruPolicy::Tick* now) noexcept
      : scores_(scores), uses_(uses), now_(now) {}

  void mark(std::uint32_t frame) const noexcept {
    if (scores_ != nullptr) {
      ClockPolicy::mark(scores_[frame]);
    } else {
      LruPolicy::mark(uses_[frame], *now_);
    }
  }

 private:
  ClockPolicy::Score* scores_;  // nullptr under LRU
  LruPolicy::Tick* uses_;
  const LruPolicy::Tick* now_;
};

/// Memory of an EvictionPolicy. The arrays of the policy that is not used are empty.
struct PolicyTables {
  std::span<FrameStates::State> states = {};
  std::span<ClockPolicy::Score> scores = {};
  std::span<LruPolicy::Tick> now = {};
  std::span<LruPolicy::Tick> uses = {};
  std::span<LruPolicy::Entry> entries = {};
};

/// Keeps the state of each frame and chooses the next frame to evict. Only the writer, the
/// holder of the cache's mutex, may call it. Readers use ReferenceBits.
class EvictionPolicy {
 public:
  using State = FrameStates::State;

  EvictionPolicy(Policy kind, const PolicyTables& tables) noexcept
      : kind_(kind),
        tables_(tables),
        states_(tables.states),
        clock_(tables.scores),
        lru_(tables.now, tables.uses, tables.entries) {}

  ReferenceBits reference_bits() const noexcept {
    return {tables_.scores.data(), tables_.uses.data(), tables_.now.data()};
  }

  State state(std::uint32_t frame) const noexcept { return states_.of(frame); }
  void pin(std::uint32_t frame) noexcept { states_.pin(frame); }
  void hold(std::uint32_t frame) noexcept { states_.hold(frame); }
  void remove(std::uint32_t frame) noexcept {
    states_.remove(frame);
    if (kind_ == Policy::kClock) clock_.remove(frame);
  }
  void release(std::uint32_t frame) noexcept {
    states_.release(frame);
    if (kind_ == Policy::kLru) lru_.release(frame);
  }
  void install(std::uint32_t frame, PageTier tier = PageTier::kLower) noexcept {
    states_.install(frame);
    if (kind_ == Policy::kLru) {
      lru_.install(frame);
    } else {
      clock_.install(frame, tier);
    }
  }
  /// Returns an evictable frame, which stays evictable until remove(); kNoFrame if there is none.
  std::uint32_t choose_victim() noexcept {
    return kind_ == Policy::kLru ? lru_.choose_victim(states_) : clock_.choose_victim(states_);
  }

 private:
  const Policy kind_;
  const PolicyTables tables_;
  FrameStates states_;
  ClockPolicy clock_;
  LruPolicy lru_;
};

}  // namespace planetree::cache
