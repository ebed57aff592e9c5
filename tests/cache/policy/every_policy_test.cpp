#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <set>
#include <thread>

#include "tests/cache/policy/policy_frames.h"
#include "tests/cache/policy/policy_kinds.h"
#include "tests/cache/policy/policy_oracle.h"
#include "tests/cache/tagged_pages.h"

// What every eviction policy has to keep.
namespace planetree::cache {
namespace {

using State = FrameStates::State;
constexpr std::uint32_t kNoPage = PolicyFrames::kNoPage;

class EveryPolicy : public testing::TestWithParam<EvictionPolicy> {
 protected:
  static PolicyFrames full(std::uint32_t frame_count) {
    PolicyFrames frames(GetParam(), frame_count, 1000);
    for (std::uint32_t page = 0; page < frame_count; ++page) frames.install(page);
    return frames;
  }
};

INSTANTIATE_TEST_SUITE_P(Policies, EveryPolicy, testing::ValuesIn(kAllPolicies), policy_test_name);

TEST_P(EveryPolicy, EvictsEachPageOnceAndThenNone) {
  for (const std::uint32_t frame_count : {1u, 2u, 3u, 10u, 41u}) {
    PolicyFrames frames = full(frame_count);
    std::set<std::uint32_t> evicted;
    for (std::uint32_t i = 0; i < frame_count; ++i) evicted.insert(frames.evict());
    EXPECT_EQ(evicted.size(), frame_count);
    EXPECT_FALSE(evicted.contains(kNoPage));
    EXPECT_EQ(frames.evict(), kNoPage);
  }
}

TEST_P(EveryPolicy, FindsAVictimWhereAllPagesWereUsedOften) {
  PolicyFrames frames = full(11);
  for (int round = 0; round < 50; ++round) {
    for (std::uint32_t frame = 0; frame < 11; ++frame) frames.use(frames.page_in(frame), 5);
    ASSERT_NE(frames.evict(), kNoPage);
    frames.install(100 + static_cast<std::uint32_t>(round));
  }
}

// Readers may mark a frame again as soon as the policy has cleared its mark.
TEST_P(EveryPolicy, EndsWhileReadersUseAllPages) {
  for (const std::uint32_t frame_count : {1u, 8u}) {
    PolicyFrames frames = full(frame_count);
    std::atomic<bool> stop{false};
    std::atomic<int> rounds{0};
    std::thread reader([&, bits = frames.evictor().reference_bits()] {
      while (!stop.load(std::memory_order_relaxed)) {
        for (std::uint32_t frame = 0; frame < frame_count; ++frame) bits.mark(frame);
        rounds.fetch_add(1, std::memory_order_relaxed);
      }
    });
    while (rounds.load() < 10) std::this_thread::yield();
    bool found = true;
    for (int i = 0; i < 20'000 && found; ++i)
      found = frames.read(100 + static_cast<std::uint32_t>(i) % 500) != kNoPage;
    stop.store(true);
    reader.join();
    EXPECT_TRUE(found) << frame_count;
  }
}

TEST_P(EveryPolicy, NeverEvictsPinnedAndHeldPages) {
  PolicyFrames frames = full(9);
  Evictor& evictor = frames.evictor();
  evictor.pin(0);
  evictor.hold(3);
  evictor.hold(8);
  for (std::uint32_t page = 100; page < 200; ++page) {
    frames.use(frames.page_in(page % 9));
    frames.read(page);
  }
  for (const std::uint32_t kept : {0u, 3u, 8u}) EXPECT_EQ(frames.page_in(kept), kept);
  for (int i = 0; i < 6; ++i) EXPECT_NE(frames.evict(), kNoPage);
  EXPECT_EQ(frames.evict(), kNoPage);
  evictor.release(3);
  evictor.release(8);
  const std::set<std::uint32_t> last = {frames.evict(), frames.evict()};
  EXPECT_EQ(last, (std::set<std::uint32_t>{3, 8}));
  EXPECT_EQ(frames.evict(), kNoPage);
  EXPECT_EQ(evictor.state(0), State::kPinned);
}

// Holds, releases, uses, reads and evicts at random. A policy returns no frame only if all resident
// pages are held.
TEST_P(EveryPolicy, FindsAVictimWheneverThereIsOne) {
  Numbers numbers(7);
  PolicyFrames frames = full(7);
  Evictor& evictor = frames.evictor();
  const auto any_is = [&](State state) {
    for (std::uint32_t frame = 0; frame < 7; ++frame)
      if (evictor.state(frame) == state) return true;
    return false;
  };
  for (int step = 0; step < 20'000; ++step) {
    const std::uint32_t frame = numbers.below(7);
    const bool is_resident = evictor.state(frame) != State::kIdle;
    switch (numbers.below(5)) {
      case 0:
        if (is_resident) evictor.hold(frame);
        break;
      case 1:
        if (is_resident) evictor.release(frame);
        break;
      case 2:
        if (is_resident) evictor.reference_bits().mark(frame);
        break;
      case 3: {
        const bool has_victim = any_is(State::kEvictable);
        ASSERT_EQ(frames.evict() != kNoPage, has_victim) << step;
        break;
      }
      default:
        if (any_is(State::kIdle)) {
          std::uint32_t page = numbers.below(20);
          while (frames.has(page)) ++page;
          frames.install(page);
        }
    }
  }
}

// A page that nobody uses does not stay for ever, even if all others are used all the time.
TEST_P(EveryPolicy, EvictsAnUnusedPageEventually) {
  PolicyFrames frames = full(12);
  for (std::uint32_t page = 100; frames.has(5); ++page) {
    ASSERT_LT(page, 400u);
    for (std::uint32_t frame = 0; frame < 12; ++frame)
      if (frames.page_in(frame) != 5) frames.use(frames.page_in(frame));
    frames.read(page);
  }
}

// Looks up a few hot pages once in as many new pages as there are 2 x frames. Returns the misses of
// hot pages in the second half.
unsigned hot_misses(EvictionPolicy policy) {
  constexpr std::uint32_t kFrames = 40, kHot = 10, kScan = 2 * kFrames, kRounds = 40;
  PolicyFrames frames(policy, kFrames, kHot + kRounds * kScan);
  unsigned missed = 0;
  // The hot pages are read again soon after their first use, so that 2Q sees them return.
  for (std::uint32_t use = 0; use < 3; ++use) {
    for (std::uint32_t page = 0; page < kHot; ++page)
      for (int times = 0; times < 2; ++times) frames.look_up(page);
    for (std::uint32_t page = 0; page < kFrames; ++page)
      frames.look_up(kHot + use * kFrames + page);
  }
  for (std::uint32_t round = 2; round < kRounds; ++round) {
    for (std::uint32_t page = 0; page < kHot; ++page)
      if (!frames.look_up(page)) missed += round >= kRounds / 2;
    for (std::uint32_t page = 0; page < kScan; ++page) frames.look_up(kHot + round * kScan + page);
  }
  return missed;
}

TEST(ScanResistance, UsedPagesOutliveScansWhereThePolicyPromisesIt) {
  EXPECT_EQ(hot_misses(EvictionPolicy::kLru), 200u);  // all of them
  for (const EvictionPolicy policy :
       {EvictionPolicy::kSieve, EvictionPolicy::kS3Fifo, EvictionPolicy::kTwoQ})
    EXPECT_EQ(hot_misses(policy), 0u) << static_cast<int>(policy);
}

// Compares the victims of a trace with those of the oracle.
void expect_victims_of_oracle(EvictionPolicy policy, std::uint32_t frame_count,
                              const std::function<std::uint32_t(int)>& page_at) {
  SCOPED_TRACE(frame_count);
  PolicyFrames frames(policy, frame_count, 1000);
  const auto oracle = make_policy_oracle(policy, frame_count);
  std::uint32_t evicted = 0;
  for (int step = 0; step < 6000; ++step) {
    const std::uint32_t page = page_at(step);
    const PageTier tier = page % 7 == 0 ? PageTier::kUpper : PageTier::kLower;
    if (frames.has(page)) {
      frames.use(page);
      oracle->use(page);
      continue;
    }
    if (frames.has(kNoPage)) {
      frames.install(page, tier);
    } else {
      ASSERT_EQ(frames.read(page, tier), oracle->evict()) << step;
      ++evicted;
    }
    oracle->install(page, tier);
  }
  EXPECT_GT(evicted, 100u);
}

TEST_P(EveryPolicy, EvictsThePagesThatItsOracleEvicts) {
  for (const std::uint32_t frame_count : {1u, 2u, 3u, 9u, 10u, 37u}) {
    Numbers numbers(frame_count);
    const std::uint32_t pages = 3 * frame_count;
    expect_victims_of_oracle(GetParam(), frame_count, [&](int) { return numbers.below(pages); });
    expect_victims_of_oracle(GetParam(), frame_count, [&](int) {
      return std::min({numbers.below(pages), numbers.below(pages), numbers.below(pages)});
    });
    // A path: neighbours of a position that moves, and at times a jump.
    std::uint32_t at = 0;
    expect_victims_of_oracle(GetParam(), frame_count, [&](int) {
      if (numbers.below(50) == 0) at = numbers.below(1000);
      at += numbers.below(40) == 0;
      return (at + numbers.below(3)) % 1000;
    });
    // A loop over a few more pages than frames.
    expect_victims_of_oracle(GetParam(), frame_count, [&](int step) {
      return static_cast<std::uint32_t>(step) % (frame_count + frame_count / 5 + 1);
    });
  }
}

}  // namespace
}  // namespace planetree::cache
