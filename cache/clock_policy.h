#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "cache/frame_pool.h"

namespace planetree::cache {

/// Which page has to go: CLOCK with scores of two bits.
///
/// A hand goes round the frames, taking one from each score it passes, and
/// stops at the first frame whose score is 0 already. Readers raise the score
/// of what they use, up to 3. A page just installed has score 2: it was wanted,
/// but one that is wanted again and again outlives it.
///
/// States of a frame, changed by the writer alone:
///
///     idle --install--> evictable --pin--> pinned
///      ^___remove_______|   ^
///                           |--hold--> held, and back by let_go
///
/// A held frame stays for a while: somebody who waited for its page has not come for it yet.
///
/// A view of memory that PageCache owns. Only mark() may be called by readers.
class ClockPolicy {
 public:
  using Score = std::atomic<std::uint8_t>;
  enum class State : std::uint8_t { kIdle = 0, kEvictable, kHeld, kPinned };

  static constexpr std::uint8_t kMaxScore = 3;
  static constexpr std::uint8_t kInstallScore = 2;

  /// `scores` and `states` have one element per frame, all 0.
  ClockPolicy(std::span<Score> scores, std::span<State> states) noexcept;

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

  /// The scores, for readers to mark.
  Score* scores() const noexcept { return scores_.data(); }

  void install(std::uint32_t frame) noexcept;
  void pin(std::uint32_t frame) noexcept;
  void remove(std::uint32_t frame) noexcept;
  /// Of a frame that is evictable, held or pinned: what is pinned stays so.
  void hold(std::uint32_t frame) noexcept;
  void let_go(std::uint32_t frame) noexcept;
  State state(std::uint32_t frame) const noexcept { return states_[frame]; }

  /// An evictable frame, which stays evictable until removed; kNoFrame if
  /// there is none.
  std::uint32_t choose_victim() noexcept;

 private:
  std::uint32_t advance() noexcept;

  std::span<Score> scores_;
  std::span<State> states_;
  std::uint32_t hand_ = 0;
};

static_assert(ClockPolicy::Score::is_always_lock_free);

}  // namespace planetree::cache
