#include "cache/spsc_ring.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "tests/cache/explorer/atomic.h"
#include "tests/cache/explorer/explore.h"

namespace planetree::cache {
namespace {

using IntRing = SpscRing<int>;

TEST(SpscRing, DeliversInOrderAndCountsDroppedRecords) {
  std::vector<IntRing::Slot> slots(IntRing::slots_for(3));
  ASSERT_EQ(slots.size(), 4u);
  IntRing ring;
  ring.attach(slots);
  std::vector<int> popped(3);
  for (int round = 0; round < 5; ++round) {
    for (int value = 0; value < 6; ++value) ring.push(10 * round + value);
    EXPECT_EQ(ring.dropped(), 2u * static_cast<unsigned>(round + 1));
    ASSERT_EQ(ring.pop(popped), 3u);
    EXPECT_EQ(popped, (std::vector<int>{10 * round, 10 * round + 1, 10 * round + 2}));
    ASSERT_EQ(ring.pop(popped), 1u);
    EXPECT_EQ(popped[0], 10 * round + 3);
    EXPECT_EQ(ring.pop(popped), 0u);
  }
}

TEST(SpscRing, DropsEveryRecordWithoutSlots) {
  IntRing ring;
  ring.push(1);
  std::vector<int> popped(1);
  EXPECT_EQ(ring.pop(popped), 0u);
  EXPECT_EQ(ring.dropped(), 1u);
}

TEST(SpscRing, ShowsStagedRecordsWhenTheyArePublished) {
  std::vector<IntRing::Slot> slots(4);
  IntRing ring;
  ring.attach(slots);
  EXPECT_FALSE(ring.has_room(1));  // not known before the first look
  ASSERT_TRUE(ring.find_room(4));
  EXPECT_FALSE(ring.find_room(5));
  ring.stage(1);
  const std::uint64_t place = ring.staged();
  EXPECT_EQ(ring.published(), 0u);
  ring.stage(2);
  ring.stage(3);
  ring.restage(place, ring.staged(place) + 40);
  std::vector<int> popped(4);
  EXPECT_EQ(ring.pop(popped), 0u);
  EXPECT_FALSE(ring.has_room(2));
  EXPECT_TRUE(ring.has_room(1));
  ring.forget_room();
  EXPECT_FALSE(ring.has_room(1));
  ring.publish();
  EXPECT_EQ(ring.published(), 3u);
  ASSERT_EQ(ring.pop(popped), 3u);
  EXPECT_EQ(popped, (std::vector<int>{1, 42, 3, 0}));
  EXPECT_FALSE(ring.has_room(2));
  EXPECT_TRUE(ring.find_room(4));
  ring.drop();
  EXPECT_EQ(ring.dropped(), 1u);
  ring.push(5);
  ring.clear();
  EXPECT_EQ(ring.dropped(), 0u);
  EXPECT_EQ(ring.pop(popped), 0u);
  EXPECT_TRUE(ring.find_room(4));
}

/// The order of one step may be weakened.
struct ExploredRing {
  template <class T>
  using Atomic = explorer::Atomic<T>;
  template <class T>
  using Plain = explorer::Plain<T>;

  static std::memory_order order(RingStep step) noexcept {
    return weakened && step == *weakened ? std::memory_order_relaxed : order_of(step);
  }
  static inline const RingStep* weakened = nullptr;
};

/// Passes 1, 2, 3, ... through two slots.
class RingProgram final : public explorer::Program {
 public:
  explicit RingProgram(std::uint64_t& lasts_taken) : lasts_taken_(lasts_taken) {
    ring_.attach(slots_);
  }

  std::uint32_t thread_count() const noexcept override { return 2; }

  void run(std::uint32_t thread) override {
    if (thread == 0) {
      ring_.push(1);
      // Two at once, the first of which is changed before the consumer may see it.
      if (ring_.find_room(2)) {
        ring_.stage(-1);
        ring_.stage(3);
        ring_.restage(ring_.staged() - 2, 2);
        ring_.publish();
      }
      ring_.push(kValues);
      return;
    }
    int last = 0;
    for (int i = 0; i < 3; ++i) {
      std::array<int, 2> popped{};
      const std::size_t count = ring_.pop(popped);
      for (std::size_t at = 0; at < count; ++at) {
        if (popped[at] <= last) explorer::Execution::current().fail("out of order");
        last = popped[at];
      }
    }
    lasts_taken_ += last == kValues;
  }

 private:
  static constexpr int kValues = 4;

  std::uint64_t& lasts_taken_;
  std::array<explorer::Plain<int>, 2> slots_;
  SpscRing<int, ExploredRing> ring_;
};

explorer::Report explore_ring() {
  std::uint64_t lasts_taken = 0;
  explorer::Report report = explorer::explore_all(
      [&] { return std::make_unique<RingProgram>(lasts_taken); }, explorer::kFewPreemptions);
  EXPECT_TRUE(lasts_taken > 0 || !report.failure.empty());
  return report;
}

TEST(SpscRingOrder, DeliversInOrderInEveryRun) { EXPECT_EQ(explore_ring().failure, ""); }

class WeakenedRing : public testing::TestWithParam<RingStep> {
 protected:
  void SetUp() override { ExploredRing::weakened = &GetParam(); }
  void TearDown() override { ExploredRing::weakened = nullptr; }
};

TEST_P(WeakenedRing, MakesSomeRunFail) { EXPECT_NE(explore_ring().failure, ""); }

INSTANTIATE_TEST_SUITE_P(Steps, WeakenedRing,
                         testing::Values(RingStep::kPublishRecord, RingStep::kSeeRecords,
                                         RingStep::kFreeSlots, RingStep::kSeeFreeSlots));

}  // namespace
}  // namespace planetree::cache
