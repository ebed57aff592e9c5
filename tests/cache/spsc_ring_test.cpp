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
      for (int value = 1; value <= kValues; ++value) ring_.push(value);
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
