#include "cache/protocol.h"

#include <gtest/gtest.h>

namespace planetree::cache {
namespace {

TEST(ReaderSlot, OccupiesOneCacheLine) {
  ReaderSlot slots[2];
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(&slots[0]) % 64, 0u);
  EXPECT_EQ(
      reinterpret_cast<std::uintptr_t>(&slots[1]) - reinterpret_cast<std::uintptr_t>(&slots[0]),
      64u);
}

TEST(ReaderSlot, SequenceIsOddInsideAndNeverRepeats) {
  ReaderSlot slot;
  for (std::uint64_t section = 0; section < 5; ++section) {
    EXPECT_FALSE(slot.inside());
    EXPECT_EQ(slot.sequence_after_withdrawal(), 2 * section);
    slot.enter();
    EXPECT_TRUE(slot.inside());
    EXPECT_EQ(slot.sequence_after_withdrawal(), 2 * section + 1);
    EXPECT_TRUE(ReaderSlot::is_inside(slot.sequence_before_reuse()));
    slot.leave();
  }
}

TEST(ReaderSlot, HasOneReaderAtATimeAndKeepsItsSequence) {
  ReaderSlot slot;
  EXPECT_FALSE(slot.claimed());
  EXPECT_TRUE(slot.try_claim());
  EXPECT_FALSE(slot.try_claim());
  slot.enter();
  slot.count_hit();
  slot.count_miss();
  slot.count_miss();
  slot.leave();
  slot.release();
  EXPECT_TRUE(slot.try_claim());
  EXPECT_EQ(slot.sequence_after_withdrawal(), 2u);
  EXPECT_EQ(slot.hits(), 1u);
  EXPECT_EQ(slot.misses(), 2u);
}

}  // namespace
}  // namespace planetree::cache
