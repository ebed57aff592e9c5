#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cache/frame_pool.h"
#include "cache/frame_states.h"

namespace planetree::cache {

/// Pages of a tree: an upper one is on the way to others.
enum class PageTier : std::uint8_t { kLower, kUpper };

/// Which page has to go: CLOCK with scores.
///
/// A hand goes round the frames, lowers each score that it passes, and stops at the first frame
/// whose score is 0 already. Readers raise the score of what they use, up to kMaxUses. A page just
/// installed has the score of kInstallUses: it was wanted, but one that is wanted again and again
/// outlives it. An upper page loses a use in kUse rounds, not in one: whoever comes this way again
/// wants it, whichever page below. But not where upper pages have more than half of the frames:
/// of those below, all that an ask needs must find room.
///
/// A view of memory that PageCache owns. Only mark() may be called by readers.
class ClockPolicy {
 public:
  using Score = std::atomic<std::uint8_t>;

  static constexpr std::uint8_t kUse = 4;
  static constexpr std::uint8_t kMaxUses = 3;
  static constexpr std::uint8_t kInstallUses = 2;

  /// `scores` has one element per frame, all 0.
  explicit ClockPolicy(std::span<Score> scores) noexcept : scores_(scores) {}

  /// Says that a frame was used. Relaxed, and free to lose a race against the
  /// hand or another reader: a score is a guess about the future, and a frame
  /// read now is kept alive by its reader's section, not by its score. Does
  /// not store at the top, so that hot frames' scores stay in every cache.
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

  /// An evictable frame; kNoFrame if there is none.
  std::uint32_t choose_victim(const FrameStates& states) noexcept;

 private:
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
