#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "cache/frame_pool.h"
#include "cache/frame_states.h"

namespace planetree::cache {

/// Which page has to go: CLOCK with scores of two bits.
///
/// A hand goes round the frames, taking one from each score it passes, and
/// stops at the first frame whose score is 0 already. Readers raise the score
/// of what they use, up to 3. A page just installed has score 2: it was wanted,
/// but one that is wanted again and again outlives it.
///
/// A view of memory that PageCache owns. Only mark() may be called by readers.
class ClockPolicy {
 public:
  using Score = std::atomic<std::uint8_t>;

  static constexpr std::uint8_t kMaxScore = 3;
  static constexpr std::uint8_t kInstallScore = 2;

  /// `scores` has one element per frame, all 0.
  explicit ClockPolicy(std::span<Score> scores) noexcept : scores_(scores) {}

  /// Says that a frame was used. Relaxed, and free to lose a race against the
  /// hand or another reader: a score is a guess about the future, and a frame
  /// read now is kept alive by its reader's section, not by its score. Does
  /// not store at the top, so that hot frames' scores stay in every cache.
  static void mark(Score& score) noexcept {
    const std::uint8_t now = score.load(std::memory_order_relaxed);
    if (now < kMaxScore) {
      score.store(static_cast<std::uint8_t>(now + 1), std::memory_order_relaxed);
    }
  }

  void install(std::uint32_t frame) noexcept {
    scores_[frame].store(kInstallScore, std::memory_order_relaxed);
  }

  /// An evictable frame; kNoFrame if there is none.
  std::uint32_t choose_victim(const FrameStates& states) noexcept;

 private:
  std::uint32_t advance() noexcept;

  std::span<Score> scores_;
  std::uint32_t hand_ = 0;
};

static_assert(ClockPolicy::Score::is_always_lock_free);

}  // namespace planetree::cache
