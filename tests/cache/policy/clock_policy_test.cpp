#include "cache/policy/clock_policy.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "tests/cache/policy/policy_frames.h"

namespace planetree::cache {
namespace {

/// Frames under CLOCK, full of pages 0, 1, ...
struct Clock : PolicyFrames {
  explicit Clock(std::uint32_t frame_count)
      : PolicyFrames(EvictionPolicy::kClock, frame_count, 1000) {
    for (std::uint32_t page = 0; page < frame_count; ++page) install(page);
  }
  unsigned score(std::uint32_t page) const {
    return tables().counts[frame_of(page)].load() & ~ReferenceBits::kReservedBit;
  }
};

TEST(ClockPolicy, EvictsUnusedPagesInTurn) {
  Clock clock(4);
  for (std::uint32_t page = 0; page < 4; ++page) EXPECT_EQ(clock.evict(), page);
}

TEST(ClockPolicy, ScoreStopsAtThreeUses) {
  Clock clock(1);
  for (const unsigned uses : {2u, 3u, 3u, 3u}) {
    EXPECT_EQ(clock.score(0), uses * ClockPolicy::kUse);
    clock.use(0);
  }
}

TEST(ClockPolicy, ScoreOfUpperPageStopsAtThreeUses) {
  Clock clock(1);
  clock.evict();
  clock.install(1, PageTier::kUpper);
  clock.use(1, 5);
  EXPECT_EQ(clock.score(1), 3u * ClockPolicy::kUse);
}

// Number of pages that pass through the other frame, one after another, before this page is
// evicted.
unsigned outlived_by(PageTier tier) {
  Clock clock(2);
  EXPECT_EQ(clock.evict(), 0u);
  clock.install(100, tier);
  unsigned outlived = 0;
  for (; clock.evict() != 100; ++outlived) clock.install(200 + outlived);
  return outlived;
}

TEST(ClockPolicy, UpperPagesKeepAUseForMoreRounds) {
  EXPECT_EQ(outlived_by(PageTier::kLower), 1u);
  EXPECT_EQ(outlived_by(PageTier::kUpper), 3u);
}

TEST(ClockPolicy, UpperPagesLoseTheirAdvantageAboveHalfTheFrames) {
  for (const std::uint32_t upper : {1u, 2u}) {
    Clock clock(3);
    for (std::uint32_t page = 0; page < 3; ++page) {
      EXPECT_EQ(clock.evict(), page);
      clock.install(10 + page, page < upper ? PageTier::kUpper : PageTier::kLower);
      clock.use(10 + page, 5);
    }
    EXPECT_EQ(clock.evict(), upper == 1 ? 11u : 10u);
  }
}

TEST(ClockPolicy, UpperPageLosesAPartlySpentUseInOneRoundAboveHalfTheFrames) {
  Clock clock(2);
  EXPECT_EQ(clock.evict(), 0u);
  clock.install(10, PageTier::kUpper);
  EXPECT_EQ(clock.evict(), 1u);
  clock.install(11);
  // The hand takes less than a whole use from the upper page.
  EXPECT_EQ(clock.evict(), 11u);
  clock.install(12, PageTier::kUpper);
  EXPECT_EQ(clock.evict(), 10u);
  EXPECT_EQ(clock.evict(), 12u);
}

TEST(ClockPolicy, UsedPagesOutliveUnusedOnes) {
  Clock clock(4);
  clock.use(0);
  clock.use(2, 5);
  EXPECT_EQ(clock.evict(), 1u);
  EXPECT_EQ(clock.evict(), 3u);
  EXPECT_EQ(clock.evict(), 0u);
  EXPECT_EQ(clock.evict(), 2u);
}

}  // namespace
}  // namespace planetree::cache
