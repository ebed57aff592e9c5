#include "cache/eviction_policy.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "tests/cache/evicting.h"

namespace planetree::cache {
namespace {

template <std::size_t kFrames>
struct Frames {
  std::array<ClockPolicy::Score, kFrames> scores{};
  std::array<FrameStates::State, kFrames> states{};
  EvictionPolicy clock{Policy::kClock, {.states = states, .scores = scores}};

  Frames() { install_all(clock, kFrames); }
  void mark(std::uint32_t frame, int times) {
    for (int i = 0; i < times; ++i) ClockPolicy::mark(scores[frame]);
  }
  std::uint32_t evict() { return evict_one(clock); }
};

TEST(ClockPolicy, EvictsUnusedFramesInTurn) {
  Frames<4> frames;
  for (std::uint32_t frame = 0; frame < 4; ++frame) EXPECT_EQ(frames.evict(), frame);
  EXPECT_EQ(frames.evict(), kNoFrame);
}

TEST(ClockPolicy, ScoreStopsAtThreeUses) {
  ClockPolicy::Score score{0};
  for (const int uses : {1, 2, 3, 3, 3}) {
    ClockPolicy::mark(score);
    EXPECT_EQ(score.load(), uses * ClockPolicy::kUse);
  }
}

TEST(ClockPolicy, InstalledFramesStartAtTwoUses) {
  Frames<2> frames;
  EXPECT_EQ(frames.scores[0].load(), 2 * ClockPolicy::kUse);
  // From a score of 0, one mark would let frame 1 go before frame 0; installing sets a higher
  // score.
  frames.scores[0].store(ClockPolicy::kUse);
  EXPECT_EQ(frames.evict(), 0u);
  EXPECT_EQ(frames.scores[1].load(), ClockPolicy::kUse);
}

// Number of pages that pass through frame 1, one after another, before the page in frame 0 is
// evicted.
unsigned outlived_by(PageTier tier) {
  Frames<2> frames;
  EXPECT_EQ(frames.evict(), 0u);
  frames.clock.install(0, tier);
  unsigned outlived = 0;
  for (; frames.evict() == 1; ++outlived) frames.clock.install(1);
  return outlived;
}

TEST(ClockPolicy, UpperPagesKeepAUseForMoreRounds) {
  EXPECT_EQ(outlived_by(PageTier::kLower), 1u);
  EXPECT_EQ(outlived_by(PageTier::kUpper), 3u);
}

TEST(ClockPolicy, UpperPagesLoseTheirAdvantageAboveHalfTheFrames) {
  for (const std::uint32_t upper : {1u, 2u}) {
    Frames<3> frames;
    for (std::uint32_t frame = 0; frame < 3; ++frame) {
      EXPECT_EQ(frames.evict(), frame);
      frames.clock.install(frame, frame < upper ? PageTier::kUpper : PageTier::kLower);
      frames.mark(frame, 5);
    }
    EXPECT_EQ(frames.evict(), upper == 1 ? 1u : 0u);
  }
}

TEST(ClockPolicy, UpperPagesAreEvictedEventually) {
  Frames<2> frames;
  for (std::uint32_t frame = 0; frame < 2; ++frame) {
    EXPECT_EQ(frames.evict(), frame);
    frames.clock.install(frame, PageTier::kUpper);
    frames.mark(frame, 5);
  }
  EXPECT_EQ(frames.evict(), 0u);
  EXPECT_EQ(frames.evict(), 1u);
}

TEST(ClockPolicy, UpperPageLosesAPartlySpentUseInOneRoundAboveHalfTheFrames) {
  Frames<2> frames;
  EXPECT_EQ(frames.evict(), 0u);
  frames.clock.install(0, PageTier::kUpper);
  EXPECT_EQ(frames.evict(), 1u);
  frames.clock.install(1);
  // The hand takes less than a whole use from the upper page.
  EXPECT_EQ(frames.evict(), 1u);
  frames.clock.install(1, PageTier::kUpper);
  EXPECT_EQ(frames.evict(), 0u);
  EXPECT_EQ(frames.evict(), 1u);
}

TEST(ClockPolicy, UpperPageScoreStopsAtThreeUses) {
  Frames<1> frames;
  EXPECT_EQ(frames.evict(), 0u);
  frames.clock.install(0, PageTier::kUpper);
  const unsigned two_uses = frames.scores[0].load();
  frames.mark(0, 5);
  EXPECT_EQ(frames.scores[0].load(), two_uses + ClockPolicy::kUse);
}

TEST(ClockPolicy, UsedFramesOutliveUnusedOnes) {
  Frames<4> frames;
  frames.mark(0, 1);
  frames.mark(2, 5);
  EXPECT_EQ(frames.evict(), 1u);
  EXPECT_EQ(frames.evict(), 3u);
  EXPECT_EQ(frames.evict(), 0u);
  EXPECT_EQ(frames.evict(), 2u);
}

TEST(ClockPolicy, SkipsPinnedAndIdleFrames) {
  Frames<4> frames;
  frames.clock.pin(0);
  frames.clock.pin(2);
  EXPECT_EQ(frames.evict(), 1u);
  EXPECT_EQ(frames.evict(), 3u);
  EXPECT_EQ(frames.evict(), kNoFrame);
  frames.clock.install(1);
  EXPECT_EQ(frames.evict(), 1u);
  EXPECT_EQ(frames.clock.state(0), FrameStates::State::kPinned);
}

TEST(ClockPolicy, FindsAVictimWhenEveryScoreIsAtItsMaximum) {
  Frames<3> frames;
  for (std::uint32_t frame = 0; frame < 3; ++frame) frames.mark(frame, 3);
  EXPECT_EQ(frames.evict(), 0u);
}

}  // namespace
}  // namespace planetree::cache
