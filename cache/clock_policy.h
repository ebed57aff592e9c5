#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cache/frame_pool.h"
#include "cache/frame_states.h"

namespace planetree::cache {

/// Upper pages link to other pages; lower pages do not.
enum class PageTier : std::uint8_t { kLower, kUpper };

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
/// A view of memory that PageCache owns. Readers may call mark() only.
class ClockPolicy {
 public:
  using Score = std::atomic<std::uint8_t>;

  static constexpr std::uint8_t kUse = 4;  ///< score of one use
  static constexpr std::uint8_t kMaxUses = 3;
  static constexpr std::uint8_t kInstallUses = 2;

  /// `scores` has one element per frame, all 0.
  explicit ClockPolicy(std::span<Score> scores) noexcept : scores_(scores) {}

  /// Records a use of a frame. The accesses are relaxed, and the store may be lost in a race
  /// with the hand or another reader: a score is only a guess about the future, and a reader's
  /// section, not the score, protects the frame it reads. Does not store at the maximum, so that
  /// the scores of hot frames stay in every processor's cache.
  static void mark(Score& score) noexcept {
    const std::uint8_t now = score.load(std::memory_order_relaxed);
    if ((now & kScoreBits) <= kUse * (kMaxUses - 1)) {
      score.store(static_cast<std::uint8_t>(now + kUse), std::memory_order_relaxed);
    }
  }

  void install(std::uint32_t frame, PageTier tier) noexcept {
    constexpr std::uint8_t kScore = kUse * kInstallUses;
    const bool upper = tier == PageTier::kUpper;
    if (upper) ++upper_count_;
    scores_[frame].store(upper ? kUpperBit | kScore : kScore, std::memory_order_relaxed);
  }
  void remove(std::uint32_t frame) noexcept {
    if (is_upper(scores_[frame].load(std::memory_order_relaxed))) --upper_count_;
  }

  /// Returns an evictable frame, or kNoFrame if there is none.
  std::uint32_t choose_victim(const FrameStates& states) noexcept;

 private:
  // A score byte has the page's tier in the upper bit and the score below.
  static constexpr std::uint8_t kUpperBit = 0x80;
  static constexpr std::uint8_t kScoreBits = 0x7f;

  static bool is_upper(std::uint8_t score) noexcept { return (score & kUpperBit) != 0; }
  std::uint32_t advance() noexcept;

  std::span<Score> scores_;
  std::uint32_t hand_ = 0;
  std::size_t upper_count_ = 0;
};

static_assert(ClockPolicy::Score::is_always_lock_free);

}  // namespace planetree::cache
