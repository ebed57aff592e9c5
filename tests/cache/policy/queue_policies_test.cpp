#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "cache/policy/ghost_list.h"
#include "tests/cache/policy/policy_frames.h"

// LRU, SIEVE, S3-FIFO and 2Q, each in a case small enough to follow.
namespace planetree::cache {
namespace {

PolicyFrames filled(EvictionPolicy policy, std::uint32_t frame_count) {
  PolicyFrames frames(policy, frame_count, 1000);
  for (std::uint32_t page = 0; page < frame_count; ++page) frames.install(page);
  return frames;
}

std::vector<std::uint32_t> evict_all(PolicyFrames& frames) {
  std::vector<std::uint32_t> evicted(frames.frame_count());
  for (std::uint32_t& page : evicted) page = frames.evict();
  return evicted;
}

using Pages = std::vector<std::uint32_t>;

TEST(LruPolicy, EvictsTheLeastRecentlyUsedPage) {
  PolicyFrames frames = filled(EvictionPolicy::kLru, 4);
  EXPECT_EQ(frames.read(10), 0u);
  frames.use(1);
  EXPECT_EQ(frames.read(11), 2u);
  EXPECT_EQ(evict_all(frames), (Pages{3, 10, 1, 11}));
}

TEST(SievePolicy, UsedPagesKeepTheirPlace) {
  PolicyFrames frames = filled(EvictionPolicy::kSieve, 4);
  frames.use(0);
  frames.use(2);
  EXPECT_EQ(frames.read(10), 1u);  // the hand has cleared 0 and goes on to 2
  EXPECT_EQ(frames.read(11), 3u);  // it has cleared 2 and goes on to 10
  EXPECT_EQ(evict_all(frames), (Pages{10, 11, 0, 2}));
}

TEST(S3FifoPolicy, OnePageOfTenIsNewAndLeavesFirst) {
  PolicyFrames frames = filled(EvictionPolicy::kS3Fifo, 10);
  for (std::uint32_t page = 0; page < 9; ++page) frames.use(page, 2);
  // Pages 0 to 8 move to the main queue. Page 9 was not used.
  EXPECT_EQ(frames.read(10), 9u);
  EXPECT_EQ(frames.read(11), 10u);
  // One use is not enough, but a page that returns is a main page.
  frames.use(11);
  EXPECT_EQ(frames.read(12), 11u);
  EXPECT_EQ(frames.read(11), 12u);
  EXPECT_EQ(frames.read(13), 0u);  // no page is new, so the oldest main page leaves
  EXPECT_EQ(frames.read(14), 13u);
  EXPECT_TRUE(frames.has(11));
}

TEST(S3FifoPolicy, MainPageGoesRoundOncePerUse) {
  PolicyFrames frames = filled(EvictionPolicy::kS3Fifo, 2);
  frames.use(0, 2);
  EXPECT_EQ(frames.read(10), 1u);  // page 0 is the only main page
  frames.use(10, 2);
  frames.use(0, 1);
  // Page 10 moves to the main queue, which is too long then: 0 goes round, 10 is older.
  EXPECT_EQ(frames.read(11), 10u);
  EXPECT_TRUE(frames.has(0));
}

TEST(TwoQPolicy, PagesThatReturnOutliveNewOnesHoweverOftenThoseAreUsed) {
  PolicyFrames frames = filled(EvictionPolicy::kTwoQ, 4);
  EXPECT_EQ(frames.read(10), 0u);
  EXPECT_EQ(frames.read(0), 1u);  // 0 returns, so it is a main page
  frames.use(2, 9);
  EXPECT_EQ(frames.read(11), 2u);
  EXPECT_EQ(frames.read(12), 3u);
  EXPECT_EQ(frames.read(13), 10u);
  EXPECT_TRUE(frames.has(0));
}

TEST(TwoQPolicy, OfPagesThatReturnedTheLeastRecentlyUsedLeavesWhenFewAreNew) {
  PolicyFrames frames = filled(EvictionPolicy::kTwoQ, 8);
  for (const std::uint32_t page : {10u, 11u, 0u, 1u}) frames.read(page);
  // The queue has 4, 5, 6, 7, 10 and 11. Three more main pages leave two of them.
  for (const std::uint32_t page : {3u, 4u, 5u, 6u}) frames.read(page);
  frames.use(0);
  EXPECT_EQ(frames.read(7), 1u);
  EXPECT_TRUE(frames.has(0));
}

TEST(GhostList, HasThePagesAddedLast) {
  std::vector<std::uint32_t> stamps(10);
  GhostList ghosts(stamps, 3);
  for (std::uint32_t page = 0; page < 5; ++page) ghosts.add(page);
  EXPECT_FALSE(ghosts.take(1));
  for (const std::uint32_t page : {2u, 3u, 4u}) {
    EXPECT_TRUE(ghosts.take(page));
    EXPECT_FALSE(ghosts.take(page));
  }
  EXPECT_FALSE(ghosts.take(9));  // never added
}

TEST(GhostList, ForgetsAllPagesWhenItsCountStartsAgain) {
  std::vector<std::uint32_t> stamps(10);
  GhostList ghosts(stamps, 3, 0xfffffffd);
  ghosts.add(0);
  ghosts.add(1);
  ghosts.add(2);  // number 2^32 stands for "never added", so this is number 1
  EXPECT_FALSE(ghosts.take(0));
  EXPECT_FALSE(ghosts.take(1));
  EXPECT_TRUE(ghosts.take(2));
}

}  // namespace
}  // namespace planetree::cache
