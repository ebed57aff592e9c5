// Caches whose pages are those of files that come and go.

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cache/page_cache.h"
#include "cache/page_ranges.h"
#include "tests/cache/tagged_pages.h"

namespace planetree::cache {
namespace {

constexpr std::uint32_t kFrameBytes = 4096;
constexpr std::uint32_t kReaders = 2;

CacheLimits shared_limits(std::uint32_t frames, EvictionPolicy policy = EvictionPolicy::kClock) {
  CacheLimits limits{};
  limits.page_count = std::uint32_t{1} << 20;
  limits.frame_bytes = kFrameBytes;
  limits.max_readers = kReaders;
  limits.is_shared = true;
  limits.policy = policy;
  limits.budget_bytes = bytes_needed(limits, frames);
  return limits;
}

class SharedCache : public testing::TestWithParam<EvictionPolicy> {
 protected:
  void make(std::uint32_t frames) {
    auto cache = PageCache::create(shared_limits(frames, GetParam()), TaggedPages::fill, &pages_);
    ASSERT_TRUE(cache) << cache.error().text;
    cache_ = *std::move(cache);
  }
  std::uint32_t add(std::uint32_t page_count, std::uint64_t bytes = 0) {
    const auto first = cache_->add_file(page_count, bytes);
    EXPECT_TRUE(first) << first.error().text;
    return first ? *first : 0;
  }
  // Reads a page of a file through a window, and checks whose it is.
  void read(Reader& window, std::uint32_t first, std::uint32_t page) {
    window.enter();
    const std::byte* frame = window.find(page);
    if (!frame) frame = window.fetch(page);
    EXPECT_TRUE(frame && TaggedPages::matches(frame, kFrameBytes, first + page));
    window.leave();
  }

  TaggedPages pages_;
  std::unique_ptr<PageCache> cache_;
};

TEST_P(SharedCache, NumbersThePagesOfEachFileFromZero) {
  make(8);
  const Reader reader = *cache_->claim_reader();
  const std::uint32_t a = add(10), b = add(20);
  EXPECT_EQ(a, 0u);
  EXPECT_EQ(b, 10u);
  Reader of_a = cache_->window(reader.index(), a), of_b = cache_->window(reader.index(), b);
  for (std::uint32_t page = 0; page < 10; ++page) {
    read(of_a, a, page);
    read(of_b, b, 2 * page + 1);
  }
  EXPECT_EQ(cache_->stats().fills, 20u);
  EXPECT_EQ(cache_->stats().evictions, 20 - cache_->frame_count());
}

TEST_P(SharedCache, ForgetsThePagesOfARemovedFile) {
  make(12);
  const Reader reader = *cache_->claim_reader();
  const std::uint32_t a = add(4), b = add(4);
  ASSERT_TRUE(cache_->pin(b));
  Reader of_a = cache_->window(reader.index(), a), of_b = cache_->window(reader.index(), b);
  for (std::uint32_t page = 0; page < 4; ++page) read(of_a, a, page);
  for (std::uint32_t page = 0; page < 4; ++page) read(of_b, b, page);
  cache_->remove_file(b, 0);
  const std::uint64_t fills = cache_->stats().fills;
  for (std::uint32_t page = 0; page < 4; ++page) read(of_a, a, page);
  EXPECT_EQ(cache_->stats().fills, fills) << "pages of the other file went too";
  const std::uint32_t c = add(4);
  EXPECT_EQ(c, b);
  Reader of_c = cache_->window(reader.index(), c);
  for (std::uint32_t page = 0; page < 4; ++page) read(of_c, c, page);
  EXPECT_EQ(cache_->stats().fills, fills + 4) << "pages of the removed file were found";
  EXPECT_EQ(cache_->stats().evictions, 4u);
}

TEST_P(SharedCache, ReadsAgainWhatWasUnreadableInARemovedFile) {
  make(8);
  const Reader reader = *cache_->claim_reader();
  const std::uint32_t a = add(70);
  pages_.make_unreadable(a + 65);
  Reader of_a = cache_->window(reader.index(), a);
  of_a.enter();
  EXPECT_EQ(of_a.fetch(65), nullptr);
  of_a.leave();
  cache_->remove_file(a, 0);
  pages_.make_readable(a + 65);
  ASSERT_EQ(add(70), a);
  read(of_a, a, 65);
}

TEST_P(SharedCache, LendsTheMemoryOfFramesAndBacksThemAgain) {
  make(64);
  const Reader reader = *cache_->claim_reader();
  const CacheStats before = cache_->stats();
  const std::uint32_t a = add(100);
  Reader of_a = cache_->window(reader.index(), a);
  for (std::uint32_t page = 0; page < 60; ++page) read(of_a, a, page);
  const std::uint32_t frames = cache_->frame_count();
  const std::uint64_t bytes = 40 * kFrameBytes;
  const std::uint32_t b = add(100, bytes);
  EXPECT_EQ(cache_->frame_count(), frames - 40);
  EXPECT_LE(cache_->stats().arena_bytes + bytes, before.arena_bytes);
  for (std::uint32_t page = 0; page < 100; ++page) read(of_a, a, page);
  cache_->remove_file(b, bytes);
  EXPECT_EQ(cache_->frame_count(), frames);
  for (std::uint32_t page = 0; page < 100; ++page) read(of_a, a, page);
  const std::uint64_t fills = cache_->stats().fills;
  for (std::uint32_t page = 100 - frames / 2; page < 100; ++page) read(of_a, a, page);
  EXPECT_EQ(cache_->stats().fills, fills) << "frames that came back are not used";
}

TEST_P(SharedCache, RefusesFilesThatLeaveTooFewFrames) {
  make(16);
  const std::uint32_t least = kReaders + 1;
  const std::uint64_t tables = page_tables_bytes(shared_limits(16, GetParam()), 10) / kFrameBytes;
  const auto refused = cache_->add_file(10, (16 - least - tables) * kFrameBytes);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kNoMemory);
  EXPECT_NE(std::string(refused.error().text).find("raise the memory budget"), std::string::npos);
  EXPECT_EQ(cache_->frame_count(), 16u);
  // The file keeps a frame for its pinned page.
  const std::uint32_t a = add(10, (16 - least - tables - 1) * kFrameBytes);
  EXPECT_EQ(cache_->frame_count(), least + 1);
  ASSERT_TRUE(cache_->pin(a));
  std::vector<Reader> readers;
  for (std::uint32_t i = 0; i < kReaders; ++i) readers.push_back(*cache_->claim_reader());
  Reader window = cache_->window(1, a);
  for (std::uint32_t page = 0; page < 10; ++page) read(window, a, page);
}

// Files come and go while a reader reads another one.
TEST_P(SharedCache, DoesNotDisturbReadersOfOtherFiles) {
  make(24);
  const std::uint32_t a = add(30);
  const Reader reader = *cache_->claim_reader(), other = *cache_->claim_reader();
  std::atomic<bool> stop{false};
  std::atomic<std::uint32_t> rounds{0};
  std::thread thread([&] {
    Reader of_a = cache_->window(reader.index(), a);
    for (std::uint32_t page = 0; !stop; page = (page + 7) % 30, ++rounds) read(of_a, a, page);
  });
  for (std::uint32_t i = 0; i < 200 || rounds < 1000; ++i) {
    const std::uint64_t bytes = (i % 12) * kFrameBytes;
    const std::uint32_t b = add(5 + i % 50, bytes);
    Reader of_b = cache_->window(other.index(), b);
    for (std::uint32_t page = 0; page < 5; ++page) read(of_b, b, page);
    cache_->remove_file(b, bytes);
  }
  stop = true;
  thread.join();
}

INSTANTIATE_TEST_SUITE_P(All, SharedCache,
                         testing::Values(EvictionPolicy::kClock, EvictionPolicy::kLru,
                                         EvictionPolicy::kSieve, EvictionPolicy::kS3Fifo,
                                         EvictionPolicy::kTwoQ));

TEST(PageRanges, ReuseTheLowestNumbersThatSuffice) {
  PageRanges ranges(100);
  EXPECT_EQ(ranges.add(10), 0u);
  EXPECT_EQ(ranges.add(20), 10u);
  EXPECT_EQ(ranges.add(30), 30u);
  EXPECT_EQ(ranges.remove(10), 20u);
  EXPECT_EQ(ranges.add(25), 60u);
  EXPECT_EQ(ranges.add(5), 10u);
  EXPECT_EQ(ranges.add(15), 15u);
  EXPECT_EQ(ranges.add(16), PageRanges::kNone);
  EXPECT_EQ(ranges.add(15), 85u);
  EXPECT_EQ(ranges.add(1), PageRanges::kNone);
  EXPECT_EQ(ranges.remove(0), 10u);
  EXPECT_EQ(ranges.add(10), 0u);
}

}  // namespace
}  // namespace planetree::cache
