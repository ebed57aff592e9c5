#pragma once

#include <concepts>
#include <cstdint>
#include <variant>

#include "cache/policy/clock_policy.h"
#include "cache/policy/frame_states.h"
#include "cache/policy/lru_policy.h"
#include "cache/policy/policy_tables.h"
#include "cache/policy/reference_bits.h"
#include "cache/policy/s3_fifo_policy.h"
#include "cache/policy/sieve_policy.h"
#include "cache/policy/two_q_policy.h"
#include "planetree/eviction_policy.h"

namespace planetree::cache {

/// What each policy has. Readers use its reference_bits(). Only the writer, the holder of the
/// cache's mutex, may call the rest.
///
///     reference_bits()                     how readers mark uses; valid as long as the tables
///     install(frame, page, tier)  a page was installed in an idle frame
///     remove(frame)               the page in this frame is evicted
///     release(frame)              a held frame is evictable again
///     choose_victim(states)       an evictable frame, or kNoFrame if there is none. It stays
///                                 evictable until remove()
template <class P>
concept PagePolicy = std::constructible_from<P, const PolicyTables&> &&
    requires(P policy, std::uint32_t frame, const FrameStates& states) {
  { policy.reference_bits() }
  noexcept->std::same_as<ReferenceBits>;
  { policy.install(frame, frame, PageTier::kLower) }
  noexcept;
  { policy.remove(frame) }
  noexcept;
  { policy.release(frame) }
  noexcept;
  { policy.choose_victim(states) }
  noexcept->std::same_as<std::uint32_t>;
};

static_assert(PagePolicy<ClockPolicy> && PagePolicy<LruPolicy> && PagePolicy<SievePolicy> &&
              PagePolicy<S3FifoPolicy> && PagePolicy<TwoQPolicy>);

/// Keeps the state of each frame and chooses the next frame to evict, by any policy. Only the
/// writer, the holder of the cache's mutex, may call it. Readers use the marks.
class Evictor {
 public:
  using State = FrameStates::State;

  /// `tables` are those that cut_policy_tables() cuts for `policy`, all 0.
  Evictor(EvictionPolicy policy, const PolicyTables& tables) noexcept
      : states_(tables.states), policy_(make(policy, tables)) {}

  ReferenceBits reference_bits() const noexcept {
    return std::visit([](const auto& policy) { return policy.reference_bits(); }, policy_);
  }

  State state(std::uint32_t frame) const noexcept { return states_.of(frame); }
  void pin(std::uint32_t frame) noexcept { states_.pin(frame); }
  void unpin(std::uint32_t frame) noexcept { states_.unpin(frame); }
  void hold(std::uint32_t frame) noexcept { states_.hold(frame); }
  void release(std::uint32_t frame) noexcept {
    states_.release(frame);
    std::visit([frame](auto& policy) { policy.release(frame); }, policy_);
  }
  void install(std::uint32_t frame, std::uint32_t page, PageTier tier = PageTier::kLower) noexcept {
    states_.install(frame);
    std::visit([&](auto& policy) { policy.install(frame, page, tier); }, policy_);
  }
  void remove(std::uint32_t frame) noexcept {
    states_.remove(frame);
    std::visit([frame](auto& policy) { policy.remove(frame); }, policy_);
  }
  /// Returns an evictable frame, which stays evictable until remove(); kNoFrame if there is none.
  std::uint32_t choose_victim() noexcept {
    return std::visit([this](auto& policy) { return policy.choose_victim(states_); }, policy_);
  }

 private:
  using AnyPolicy = std::variant<ClockPolicy, LruPolicy, SievePolicy, S3FifoPolicy, TwoQPolicy>;

  static AnyPolicy make(EvictionPolicy policy, const PolicyTables& tables) noexcept {
    switch (policy) {
      case EvictionPolicy::kLru:
        return LruPolicy(tables);
      case EvictionPolicy::kSieve:
        return SievePolicy(tables);
      case EvictionPolicy::kS3Fifo:
        return S3FifoPolicy(tables);
      case EvictionPolicy::kTwoQ:
        return TwoQPolicy(tables);
      case EvictionPolicy::kClock:
        break;
    }
    return ClockPolicy(tables);
  }

  FrameStates states_;
  AnyPolicy policy_;
};

}  // namespace planetree::cache
