#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "cache/page_cache.h"
#include "tests/cache/policy/policy_kinds.h"
#include "tests/cache/tagged_pages.h"

namespace planetree::cache {
namespace {

constexpr std::uint32_t kStormPages = 64;
// The size of a system page, so that a budget can give an exact number of frames.
constexpr std::uint32_t kStormFrameBytes = 4096;
constexpr std::uint32_t kUnreadable = 13;

/// Counts of one thread.
struct Seen {
  std::uint64_t finds = 0;
  std::uint64_t wrong = 0;       ///< frames with a word of another page
  std::uint64_t unreadable = 0;  ///< pages other than kUnreadable that could not be fetched
};

void check_frame(const std::byte* frame, std::uint32_t page, Seen& seen) {
  if (frame == nullptr) {
    seen.unreadable += page != kUnreadable;
  } else {
    seen.wrong += !TaggedPages::matches(frame, kStormFrameBytes, page);
  }
}

/// Runs one section: finds or fetches some pages. Pointers found since the last fetch are kept and
/// read again at the end of the section, when other threads have withdrawn many of these pages.
void run_section(Reader& reader, Numbers& numbers, Seen& seen) {
  constexpr std::uint32_t kLookups = 12;
  const std::byte* frames[kLookups];
  std::uint32_t pages[kLookups];
  std::uint32_t kept = 0;
  reader.enter();
  for (std::uint32_t i = 0; i < kLookups; ++i) {
    const std::uint32_t page = numbers.below(kStormPages);
    const std::byte* frame = reader.find(page);
    ++seen.finds;
    if (frame == nullptr) {
      // Mostly find only, so that pointers are kept for long.
      if (numbers.below(4) != 0) continue;
      kept = 0;
      frame = reader.fetch(page);
    }
    check_frame(frame, page, seen);
    if (frame == nullptr) continue;
    frames[kept] = frame;
    pages[kept++] = page;
  }
  // Lets other threads evict during the section, on few cores too.
  if (numbers.below(64) == 0) std::this_thread::yield();
  for (std::uint32_t i = 0; i < kept; ++i) check_frame(frames[i], pages[i], seen);
  reader.leave();
}

void run_reader(PageCache& cache, std::uint64_t seed, std::uint32_t sections, Seen& seen) {
  Numbers numbers(seed);
  std::uint32_t done = 0;
  while (done < sections) {
    // Readers also change slots.
    Result<Reader> reader = cache.claim_reader();
    ASSERT_TRUE(reader);
    for (std::uint32_t i = 0; i < 50 && done < sections; ++i, ++done) {
      run_section(*reader, numbers, seen);
    }
  }
}

void storm(std::uint32_t reader_count, std::uint32_t frame_count, EvictionPolicy policy) {
  TaggedPages pages;
  pages.make_unreadable(kUnreadable);
  auto created = PageCache::create(
      limits_for_frames(frame_count, kStormPages, reader_count, kStormFrameBytes, policy),
      TaggedPages::fill, &pages);
  ASSERT_TRUE(created);
  PageCache& cache = **created;
  ASSERT_EQ(cache.stats().frame_count, frame_count);
  ASSERT_TRUE(cache.pin(0));

  std::vector<Seen> seen(reader_count);
  std::vector<std::thread> threads;
  std::atomic<std::uint32_t> waiting{reader_count};
  for (std::uint32_t i = 0; i < reader_count; ++i) {
    threads.emplace_back([&cache, &seen, &waiting, i, reader_count] {
      // All start together; otherwise the first could end before the last begins.
      --waiting;
      while (waiting != 0) std::this_thread::yield();
      Seen mine;
      run_reader(cache, i + 1, 5000 / reader_count, mine);
      seen[i] = mine;
    });
  }
  for (std::thread& thread : threads) thread.join();

  const CacheStats stats = cache.stats();
  std::uint64_t finds = 0;
  for (const Seen& one : seen) {
    finds += one.finds;
    EXPECT_EQ(one.wrong, 0u);
    EXPECT_EQ(one.unreadable, 0u);
  }
  EXPECT_EQ(stats.hits + stats.misses, finds);
  EXPECT_EQ(stats.fills + stats.quarantined, pages.fill_calls());
  EXPECT_EQ(stats.quarantined, 1u);
  EXPECT_GT(stats.evictions, 1000u);
  EXPECT_LE(stats.fills - stats.evictions, frame_count);
}

class PageCacheStress : public testing::TestWithParam<EvictionPolicy> {};
INSTANTIATE_TEST_SUITE_P(Policies, PageCacheStress, testing::ValuesIn(kAllPolicies),
                         policy_test_name);

TEST_P(PageCacheStress, ReadersNeverSeeAnotherPagesBytes) {
  for (const std::uint32_t reader_count : {1u, 2u, 3u, 4u, 8u}) {
    SCOPED_TRACE(reader_count);
    storm(reader_count, reader_count + 2, GetParam());
  }
}

TEST_P(PageCacheStress, ReadersNeverSeeAnotherPagesBytesWithSpareFrames) {
  for (const std::uint32_t reader_count : {2u, 8u}) {
    SCOPED_TRACE(reader_count);
    storm(reader_count, 24, GetParam());
  }
}

}  // namespace
}  // namespace planetree::cache
