#include "cache/eviction_policy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <list>

#include "cache/page_cache.h"
#include "tests/cache/evicting.h"
#include "tests/cache/tagged_pages.h"

namespace planetree::cache {
namespace {

template <std::size_t kFrames>
struct LruFrames {
  std::array<FrameStates::State, kFrames> states{};
  std::array<LruPolicy::Tick, 1> now{};
  std::array<LruPolicy::Tick, kFrames> uses{};
  std::array<LruPolicy::Entry, kFrames> entries{};
  EvictionPolicy lru{
      Policy::kLru, {.states = states, .scores = {}, .now = now, .uses = uses, .entries = entries}};

  LruFrames() { install_all(lru, kFrames); }
  void use(std::uint32_t frame) { lru.reference_bits().mark(frame); }
  std::uint32_t evict() { return evict_one(lru); }
};

TEST(LruPolicy, EvictsTheLeastRecentlyUsedFrame) {
  LruFrames<4> frames;
  EXPECT_EQ(frames.evict(), 0u);
  frames.lru.install(0);
  frames.use(1);
  EXPECT_EQ(frames.evict(), 2u);
  EXPECT_EQ(frames.evict(), 3u);
  EXPECT_EQ(frames.evict(), 0u);
  EXPECT_EQ(frames.evict(), 1u);
  EXPECT_EQ(frames.evict(), kNoFrame);
}

TEST(LruPolicy, SkipsPinnedAndHeldFrames) {
  LruFrames<4> frames;
  frames.lru.pin(0);
  frames.lru.hold(1);
  EXPECT_EQ(frames.evict(), 2u);
  EXPECT_EQ(frames.evict(), 3u);
  EXPECT_EQ(frames.evict(), kNoFrame);
  frames.lru.release(1);
  EXPECT_EQ(frames.evict(), 1u);
  EXPECT_EQ(frames.evict(), kNoFrame);
}

// Compares with a list that is reordered at every use.
TEST(LruPolicy, MatchesAListKeptInOrderOfUse) {
  constexpr std::uint32_t kBookFrames = 23;
  LruFrames<kBookFrames> frames;
  std::list<std::uint32_t> by_use;  // most recently used at the back
  for (std::uint32_t frame = 0; frame < kBookFrames; ++frame) by_use.push_back(frame);
  Numbers numbers(5);
  for (int step = 0; step < 5000; ++step) {
    // At most one use between two installs, so that no two uses have the same time.
    const std::uint32_t victim = frames.evict();
    ASSERT_EQ(victim, by_use.front()) << step;
    frames.lru.install(victim);
    by_use.splice(by_use.end(), by_use, by_use.begin());
    const std::uint32_t used = numbers.below(kBookFrames);
    if (used == victim) continue;
    // A use has the same time as the install before it; among these the lesser frame number goes
    // first.
    if (used < victim) continue;
    frames.use(used);
    by_use.splice(by_use.end(), by_use, std::find(by_use.begin(), by_use.end(), used));
  }
}

TEST(LruPolicy, CacheReturnsCorrectPagesUnderEitherPolicy) {
  for (const Policy policy : {Policy::kClock, Policy::kLru}) {
    TaggedPages pages;
    CacheLimits limits{0, 100, 4096, 2, 0, policy};
    limits.budget_bytes = bytes_needed(limits, 12);
    auto cache = PageCache::create(limits, TaggedPages::fill, &pages);
    ASSERT_TRUE(cache);
    Reader reader = *(*cache)->claim_reader();
    Numbers numbers(3);
    reader.enter();
    for (int i = 0; i < 3000; ++i) {
      const std::uint32_t page = std::min(numbers.below(100), numbers.below(100));
      const std::byte* frame = reader.find(page);
      if (!frame) frame = reader.fetch(page);
      ASSERT_TRUE(TaggedPages::matches(frame, 4096, page));
    }
    reader.leave();
    EXPECT_GT((*cache)->stats().evictions, 1000u);
    EXPECT_EQ((*cache)->stats().frame_count, 12u);
  }
}

}  // namespace
}  // namespace planetree::cache
