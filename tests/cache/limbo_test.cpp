#include "cache/limbo.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace planetree::cache {
namespace {

/// Two readers, and so three fetchers.
struct LimboOfTwo {
  std::array<ReaderSlot, 2> slots{};
  std::array<Limbo::Entry, 3> entries{};
  std::array<std::uint64_t, 6> stamps{};
  Limbo limbo{slots, entries, stamps};
};

TEST(Limbo, ReturnsAFrameAtOnceWithoutOpenSections) {
  LimboOfTwo two;
  EXPECT_FALSE(two.limbo.holds(1));
  EXPECT_EQ(two.limbo.take(1), kNoFrame);
  two.limbo.retire(1, 7);
  EXPECT_TRUE(two.limbo.holds(1));
  EXPECT_EQ(two.limbo.take(0), kNoFrame);
  EXPECT_EQ(two.limbo.take(1), 7u);
  EXPECT_FALSE(two.limbo.holds(1));
}

TEST(Limbo, WaitsForEverySectionThatWasOpen) {
  LimboOfTwo two;
  two.slots[0].enter();
  two.slots[1].enter();
  two.limbo.retire(2, 7);
  EXPECT_EQ(two.limbo.take(2), kNoFrame);
  two.slots[1].leave();
  EXPECT_EQ(two.limbo.take(2), kNoFrame);
  two.slots[0].leave();
  EXPECT_EQ(two.limbo.take(2), 7u);
}

TEST(Limbo, DoesNotWaitForLaterSections) {
  LimboOfTwo two;
  two.slots[0].enter();
  two.limbo.retire(2, 7);
  two.slots[1].enter();  // begun after the page was withdrawn
  two.slots[0].leave();
  two.slots[0].enter();  // inside again, but in a later section
  EXPECT_EQ(two.limbo.take(2), 7u);
}

TEST(Limbo, EndedSectionStaysEndedAfterTheReaderReenters) {
  LimboOfTwo two;
  two.slots[0].enter();
  two.slots[1].enter();
  two.limbo.retire(2, 7);
  two.slots[0].leave();
  EXPECT_EQ(two.limbo.take(2), kNoFrame);
  two.slots[0].enter();
  two.slots[1].leave();
  EXPECT_EQ(two.limbo.take(2), 7u);
}

TEST(Limbo, FramesWaitOnlyForTheSectionsNotedForThem) {
  LimboOfTwo two;
  two.limbo.retire(0, 5);
  two.slots[1].enter();
  two.limbo.retire(1, 6);
  EXPECT_EQ(two.limbo.take(1), kNoFrame);
  EXPECT_EQ(two.limbo.take(0), 5u);
}

TEST(Limbo, AwaitedFramesAreLeftToTheirFetcher) {
  LimboOfTwo two;
  two.limbo.retire(0, 5);
  two.limbo.retire(1, 6);
  two.limbo.set_awaited(0, true);
  EXPECT_EQ(two.limbo.take_unawaited(), 6u);
  EXPECT_EQ(two.limbo.take_unawaited(), kNoFrame);
  two.limbo.set_awaited(0, false);
  EXPECT_EQ(two.limbo.take_unawaited(), 5u);
}

TEST(Limbo, UnawaitedFrameCanBeAdoptedWithItsSections) {
  LimboOfTwo two;
  two.slots[0].enter();
  two.limbo.retire(0, 5);
  two.limbo.set_awaited(0, true);
  EXPECT_FALSE(two.limbo.adopt(1));
  two.limbo.set_awaited(0, false);
  EXPECT_TRUE(two.limbo.adopt(1));
  EXPECT_FALSE(two.limbo.holds(0));
  // The sections that the frame waits for move with it.
  EXPECT_EQ(two.limbo.take(1), kNoFrame);
  two.slots[0].leave();
  EXPECT_EQ(two.limbo.take(1), 5u);
}

}  // namespace
}  // namespace planetree::cache
