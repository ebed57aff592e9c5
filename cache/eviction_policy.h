#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cache/frame_pool.h"

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

/// Chooses the page to evict: the least recently used one.
///
/// Time is the number of pages installed so far. It does not change while all pages requested are
/// resident, so its cache line then stays in every processor's cache. Uses between two installs
/// count as equally old. Readers store the time in the frames that they use. The writer keeps the
/// frames in a heap, ordered by the last use that it has read. It reads the last use of the top
/// frame again and moves the frame down if readers have used it since.
///
/// A view of memory that PageCache owns. Readers may call mark() only.
class LruPolicy {
 public:
  using Tick = std::atomic<std::uint64_t>;
  struct Entry {
    std::uint64_t last_use;  ///< last use of this frame that the writer has read
    std::uint32_t heap;      ///< frame at this position of the heap
    bool in_heap;            ///< whether this frame is in the heap
  };

  /// `now` has one tick, on a cache line of its own. `uses` and `entries` have one element per
  /// frame. All are 0.
  LruPolicy(std::span<Tick> now, std::span<Tick> uses, std::span<Entry> entries) noexcept
      : now_(now), uses_(uses), entries_(entries) {}

  /// Records a use of a frame. Relaxed, for the reasons given at ClockPolicy::mark().
  static void mark(Tick& use, const Tick& now) noexcept {
    const std::uint64_t time = now.load(std::memory_order_relaxed);
    if (use.load(std::memory_order_relaxed) != time) use.store(time, std::memory_order_relaxed);
  }

  void install(std::uint32_t frame) noexcept;
  /// Adds a frame that has become evictable again.
  void release(std::uint32_t frame) noexcept { push(frame); }

  /// Returns an evictable frame, or kNoFrame if there is none.
  std::uint32_t choose_victim(const FrameStates& states) noexcept;

 private:
  void push(std::uint32_t frame) noexcept;
  void pop() noexcept;
  void sink() noexcept;
  bool is_before(std::uint32_t frame, std::uint32_t other) const noexcept;

  std::span<Tick> now_;
  std::span<Tick> uses_;
  std::span<Entry> entries_;
  std::uint32_t size_ = 0;  // frames in the heap
};

static_assert(LruPolicy::Tick::is_always_lock_free);

/// Which page is evicted when another page needs its frame.
enum class Policy : std::uint8_t { kClock, kLru };

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
