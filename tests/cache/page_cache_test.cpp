#include "cache/page_cache.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>
#include <vector>

#include "tests/cache/allocation_count.h"
#include "tests/cache/tagged_pages.h"

namespace planetree::cache {
namespace {

constexpr std::uint32_t kFrameBytes = 4096;

std::unique_ptr<PageCache> make_cache(const CacheLimits& limits, TaggedPages& pages) {
  auto cache = PageCache::create(limits, TaggedPages::fill, &pages);
  EXPECT_TRUE(cache);
  return cache ? *std::move(cache) : nullptr;
}

Reader make_reader(PageCache& cache) {
  Result<Reader> reader = cache.claim_reader();
  EXPECT_TRUE(reader);
  return *std::move(reader);
}

/// Finds the page, or else fetches it.
const std::byte* get(Reader& reader, std::uint32_t page) {
  const std::byte* frame = reader.find(page);
  return frame != nullptr ? frame : reader.fetch(page);
}

TEST(PageCache, FirstFindMissesAndLaterFindsHit) {
  TaggedPages pages;
  const auto cache = make_cache(limits_for_frames(6, 50, 2), pages);
  Reader reader = make_reader(*cache);
  reader.enter();
  EXPECT_EQ(reader.find(7), nullptr);
  const std::byte* fetched = reader.fetch(7);
  ASSERT_NE(fetched, nullptr);
  EXPECT_TRUE(reader.inside());
  EXPECT_TRUE(TaggedPages::matches(fetched, kFrameBytes, 7));
  EXPECT_EQ(reader.find(7), fetched);
  EXPECT_EQ(reader.find(7), fetched);
  EXPECT_EQ(reader.fetch(7), fetched);  // resident already: not filled again
  reader.leave();
  const CacheStats stats = cache->stats();
  EXPECT_EQ(stats.hits, 2u);
  EXPECT_EQ(stats.misses, 1u);
  EXPECT_EQ(stats.fills, 1u);
  EXPECT_EQ(stats.evictions, 0u);
  EXPECT_EQ(pages.fill_calls(), 1u);
}

TEST(PageCache, EvictsOnlyWhenFramesRunOut) {
  TaggedPages pages;
  const auto cache = make_cache(limits_for_frames(6, 50, 2), pages);
  Reader reader = make_reader(*cache);
  reader.enter();
  for (std::uint32_t page = 0; page < 6; ++page) reader.fetch(page);
  EXPECT_EQ(cache->stats().evictions, 0u);
  for (std::uint32_t page = 6; page < 26; ++page) reader.fetch(page);
  EXPECT_EQ(cache->stats().evictions, 20u);
  EXPECT_EQ(cache->stats().fills, 26u);
  std::uint32_t resident = 0;
  for (std::uint32_t page = 0; page < 50; ++page) {
    const std::byte* frame = reader.find(page);
    if (frame == nullptr) continue;
    ++resident;
    EXPECT_TRUE(TaggedPages::matches(frame, kFrameBytes, page));
  }
  reader.leave();
  EXPECT_EQ(resident, 6u);
}

TEST(PageCache, KeepsPagesThatAreFoundOften) {
  TaggedPages pages;
  const auto cache = make_cache(limits_for_frames(6, 50, 2), pages);
  Reader reader = make_reader(*cache);
  reader.enter();
  for (std::uint32_t page = 0; page < 50; ++page) {
    for (int use = 0; use < 3; ++use) EXPECT_NE(get(reader, 3), nullptr);
    get(reader, page);
  }
  reader.leave();
  // Page 3 was read once. Under FIFO eviction it would have been evicted eight times.
  EXPECT_EQ(cache->stats().fills, 50u);
}

TEST(PageCache, NeverExceedsItsBudget) {
  for (std::uint64_t extra = 0; extra < 900'000; extra += 12'345) {
    TaggedPages pages;
    CacheLimits limits{0, 200, kFrameBytes, 3, 5000};
    limits.budget_bytes = minimum_budget_bytes(limits) + extra;
    const auto cache = make_cache(limits, pages);
    const CacheStats stats = cache->stats();
    EXPECT_EQ(stats.budget_bytes, limits.budget_bytes);
    EXPECT_EQ(stats.reserved_bytes, 5000u);
    const std::uint64_t held =
        stats.arena_bytes + stats.table_bytes + stats.reserved_bytes + sizeof(PageCache);
    EXPECT_LE(held, limits.budget_bytes);
    EXPECT_GE(stats.arena_bytes, std::uint64_t{stats.frame_count} * kFrameBytes);
    EXPECT_LE(stats.frame_count, 200u);
    // The remainder of the budget is too small for one more frame.
    if (stats.frame_count < 200) {
      EXPECT_LT(limits.budget_bytes - held, kFrameBytes + 8192);
    }
  }
}

TEST(PageCache, PinnedPageSurvivesEvictionOfAllOthers) {
  TaggedPages pages;
  const auto cache = make_cache(limits_for_frames(6, 300, 2), pages);
  ASSERT_TRUE(cache->pin(0));
  Reader reader = make_reader(*cache);
  reader.enter();
  const std::byte* root = reader.find(0);
  ASSERT_NE(root, nullptr);
  ASSERT_EQ(cache->stats().fills, 1u);
  // The root is not found meanwhile, so its score does not protect it.
  for (std::uint32_t page = 1; page < 300; ++page) ASSERT_NE(reader.fetch(page), nullptr);
  EXPECT_EQ(reader.find(0), root);
  EXPECT_TRUE(TaggedPages::matches(root, kFrameBytes, 0));
  reader.leave();
  EXPECT_EQ(cache->stats().evictions, 300u - 6u);
}

TEST(PageCache, RefusesToPinWhereFetchesWouldLackFrames) {
  TaggedPages pages;
  const auto cache = make_cache(limits_for_frames(6, 50, 2), pages);
  for (std::uint32_t page = 0; page < 3; ++page) ASSERT_TRUE(cache->pin(page));
  ASSERT_TRUE(cache->pin(1));  // already pinned: needs no further frame
  const Result<void> refused = cache->pin(3);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kNoMemory);
  EXPECT_EQ(refused.error().page, 3u);
}

TEST(PageCache, SmallestCacheCanPinItsRoot) {
  TaggedPages pages;
  const auto cache = make_cache(limits_for_frames(4, 50, 2), pages);
  EXPECT_TRUE(cache->pin(0));
  EXPECT_FALSE(cache->pin(1));
}

TEST(PageCache, PinsEveryPageIfEachHasAFrame) {
  TaggedPages pages;
  const auto cache = make_cache(limits_for_frames(3, 3, 8), pages);
  for (std::uint32_t page = 0; page < 3; ++page) EXPECT_TRUE(cache->pin(page));
  EXPECT_EQ(cache->stats().evictions, 0u);
}

TEST(PageCache, QuarantinesUnreadablePages) {
  TaggedPages pages;
  pages.make_unreadable(5);
  pages.make_unreadable(6);
  const auto cache = make_cache(limits_for_frames(4, 50, 2), pages);
  Reader reader = make_reader(*cache);
  reader.enter();
  EXPECT_EQ(reader.fetch(5), nullptr);
  EXPECT_TRUE(reader.inside());
  EXPECT_EQ(reader.find(5), nullptr);
  EXPECT_EQ(reader.fetch(5), nullptr);
  reader.leave();
  EXPECT_EQ(pages.fill_calls(), 1u);  // not retried
  EXPECT_EQ(cache->stats().quarantined, 1u);

  const Result<void> first = cache->pin(6);
  ASSERT_FALSE(first);
  EXPECT_STREQ(first.error().text, "page 6 is damaged");
  const Result<void> second = cache->pin(6);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::kDamaged);
  EXPECT_EQ(second.error().page, 6u);
  EXPECT_EQ(cache->stats().quarantined, 2u);

  // Frames of failed fills are reusable.
  reader.enter();
  for (std::uint32_t page = 7; page < 11; ++page) EXPECT_NE(reader.fetch(page), nullptr);
  reader.leave();
  EXPECT_EQ(cache->stats().evictions, 0u);
}

TEST(PageCache, FailedFillsEvictOnlyOnePage) {
  TaggedPages pages;
  for (std::uint32_t page = 10; page < 40; ++page) pages.make_unreadable(page);
  const auto cache = make_cache(limits_for_frames(4, 50, 2), pages);
  Reader reader = make_reader(*cache);
  reader.enter();
  for (std::uint32_t page = 0; page < 4; ++page) reader.fetch(page);
  for (std::uint32_t page = 10; page < 40; ++page) EXPECT_EQ(reader.fetch(page), nullptr);
  // One page was evicted, once. No page shows the bytes of a failed fill.
  EXPECT_EQ(cache->stats().evictions, 1u);
  for (std::uint32_t page = 0; page < 50; ++page) {
    const std::byte* frame = reader.find(page);
    if (frame != nullptr) {
      EXPECT_TRUE(TaggedPages::matches(frame, kFrameBytes, page));
    }
  }
  reader.leave();
}

TEST(PageCache, RefusesMoreReadersThanMaxReaders) {
  TaggedPages pages;
  const auto cache = make_cache(limits_for_frames(8, 50, 3), pages);
  Reader first = make_reader(*cache);
  {
    Reader second = make_reader(*cache);
    const Reader third = make_reader(*cache);
    const Result<Reader> refused = cache->claim_reader();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kBadArgument);
    EXPECT_NE(std::strstr(refused.error().text, "max_probes"), nullptr);
    second.enter();  // leaves the section when destroyed
  }
  Reader fourth = make_reader(*cache);
  Reader fifth = make_reader(*cache);
  EXPECT_FALSE(fourth.inside());
  EXPECT_FALSE(fifth.inside());
  EXPECT_FALSE(cache->claim_reader());
  fourth = std::move(fifth);  // releases its former slot
  EXPECT_TRUE(cache->claim_reader());
}

TEST(PageCache, StatsKeepTheCountsOfDestroyedReaders) {
  TaggedPages pages;
  const auto cache = make_cache(limits_for_frames(8, 50, 1), pages);
  for (int i = 0; i < 3; ++i) {
    Reader reader = make_reader(*cache);
    reader.enter();
    get(reader, 1);
    reader.leave();
  }
  EXPECT_EQ(cache->stats().hits, 2u);
  EXPECT_EQ(cache->stats().misses, 1u);
}

TEST(PageCache, AllocatesNothingOnceCreated) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns operator new";
  TaggedPages pages;
  pages.make_unreadable(9);
  const std::uint64_t before_create = allocation_count();
  const auto cache = make_cache(limits_for_frames(6, 50, 2), pages);
  EXPECT_EQ(allocation_count(), before_create + 1);  // one object: the counter works
  const std::uint64_t after_create = allocation_count();
  ASSERT_TRUE(cache->pin(0));
  {
    Reader reader = make_reader(*cache);
    Numbers numbers(1);
    for (int i = 0; i < 1000; ++i) {
      reader.enter();
      for (int j = 0; j < 5; ++j) get(reader, numbers.below(50));
      reader.leave();
    }
    EXPECT_GT(cache->stats().evictions, 1000u);
    EXPECT_EQ(cache->stats().quarantined, 1u);
  }
  EXPECT_EQ(allocation_count(), after_create);
}

/// Walks from page to page; the bytes of each page choose the next.
std::uint64_t walk(PageCache& cache, std::uint32_t page_count) {
  Reader reader = make_reader(cache);
  std::uint64_t answer = 0;
  std::uint32_t page = 0;
  for (std::uint32_t step = 0; step < 3000; ++step) {
    if (step % 16 == 0) reader.enter();
    const std::byte* frame = get(reader, page);
    std::uint64_t found = page;
    if (frame != nullptr) std::memcpy(&found, frame + step * 8 % kFrameBytes, sizeof found);
    answer = answer * 31 + found;
    page = static_cast<std::uint32_t>((answer >> 20) % page_count);
    if (step % 16 == 15) reader.leave();
  }
  return answer;
}

TEST(PageCache, AnswersAreTheSameAtAnyBudget) {
  constexpr std::uint32_t kPages = 100;
  std::vector<std::uint64_t> answers;
  std::vector<std::uint64_t> fills;
  for (const std::uint32_t frames : {4u, 5u, 10u, 50u, 99u, 100u}) {
    TaggedPages pages;
    pages.make_unreadable(17);
    const auto cache = make_cache(limits_for_frames(frames, kPages, 2), pages);
    EXPECT_EQ(cache->stats().frame_count, frames);
    answers.push_back(walk(*cache, kPages));
    fills.push_back(cache->stats().fills);
  }
  for (const std::uint64_t answer : answers) EXPECT_EQ(answer, answers.front());
  EXPECT_EQ(fills.back(), kPages - 1u);  // every page except 17, once
  EXPECT_GT(fills.front(), 2000u);
}

/// Detects fills while another reader is inside its section. All operations are relaxed, so that
/// only the cache orders one thread's reads of a frame before another's writes, and ThreadSanitizer
/// reports it if the cache does not.
struct WatchedPages {
  std::atomic<bool> holder_inside{false};
  std::atomic<int> fills_while_held{0};

  static Result<FillResult> fill(void* context, const FillRequest& request) {
    auto& watched = *static_cast<WatchedPages*>(context);
    if (watched.holder_inside.load(std::memory_order_relaxed)) {
      watched.fills_while_held.fetch_add(1, std::memory_order_relaxed);
    }
    TaggedPages tags;
    return TaggedPages::fill(&tags, request);
  }
};

TEST(PageCache, FetchWaitsForSectionsThatMayHoldTheFrame) {
  WatchedPages watched;
  auto created = PageCache::create(limits_for_frames(4, 50, 2), WatchedPages::fill, &watched);
  ASSERT_TRUE(created);
  PageCache& cache = **created;
  Reader holder = make_reader(cache);
  holder.enter();
  for (std::uint32_t page = 0; page < 4; ++page) holder.fetch(page);
  const std::byte* held[4];
  for (std::uint32_t page = 0; page < 4; ++page) held[page] = holder.find(page);
  watched.holder_inside.store(true, std::memory_order_relaxed);

  std::thread other([&cache] {
    Reader reader = make_reader(cache);
    reader.enter();
    EXPECT_TRUE(TaggedPages::matches(reader.fetch(30), kFrameBytes, 30));
    reader.leave();
  });
  // The other thread has withdrawn a page and now has to wait.
  while (cache.stats().evictions == 0) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(cache.stats().evictions, 1u);  // it evicts no more meanwhile
  for (std::uint32_t page = 0; page < 4; ++page) {
    EXPECT_TRUE(TaggedPages::matches(held[page], kFrameBytes, page));
  }
  watched.holder_inside.store(false, std::memory_order_relaxed);
  holder.leave();
  other.join();
  EXPECT_EQ(watched.fills_while_held, 0);
}

}  // namespace
}  // namespace planetree::cache
