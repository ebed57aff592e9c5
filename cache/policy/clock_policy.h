#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cache/policy/frame_states.h"
#include "cache/policy/policy_tables.h"
#include "cache/policy/reference_bits.h"

namespace planetree::cache {

/// Chooses the page to evict: CLOCK with scores.
///
/// A hand passes over the frames in a circle, lowers each score that it passes, and stops at the
/// first frame whose score is already 0. Readers raise the score of each frame they use, up to
/// kMaxUses uses. A newly installed page starts with kInstallUses uses, so that pages used
/// repeatedly outlive it.
///
/// An upper page loses a use in kUse rounds instead of one, because later queries of any page
/// below it need it too. This does not apply while upper pages have more than half of the
/// frames: all lower pages that one query needs must fit in the rest.
///
/// A view of memory that PageCache owns.
class ClockPolicy {
 public:
  static constexpr std::uint8_t kUse = 4;  ///< score of one use
  static constexpr std::uint8_t kMaxUses = 3;
  static constexpr std::uint8_t kInstallUses = 2;

  explicit ClockPolicy(const PolicyTables& tables) noexcept : scores_(tables.counts) {}

  ReferenceBits reference_bits() const noexcept {
    return ReferenceBits::counting(scores_.data(), kUse, kUse * (kMaxUses - 1));
  }

  void install(std::uint32_t frame, std::uint32_t /*page*/, PageTier tier) noexcept {
    constexpr std::uint8_t kScore = kUse * kInstallUses;
    const bool upper = tier == PageTier::kUpper;
    if (upper) ++upper_count_;
    scores_[frame].store(upper ? kUpperBit | kScore : kScore, std::memory_order_relaxed);
  }
  void remove(std::uint32_t frame) noexcept {
    if (is_upper(scores_[frame].load(std::memory_order_relaxed))) --upper_count_;
  }
  void release(std::uint32_t /*frame*/) noexcept {}
  std::uint32_t choose_victim(const FrameStates& states) noexcept;

 private:
  // A score byte has the page's tier in the upper bit and the score below.
  static constexpr std::uint8_t kUpperBit = ReferenceBits::kReservedBit;
  static constexpr std::uint8_t kScoreBits = 0x7f;

  static bool is_upper(std::uint8_t score) noexcept { return (score & kUpperBit) != 0; }
  std::uint32_t advance() noexcept;

  std::span<UseCount> scores_;
  std::uint32_t hand_ = 0;
  std::size_t upper_count_ = 0;
};

}  // namespace planetree::cache
