#include "cache/cache_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>

#include "cache/page_cache.h"
#include "tests/cache/tagged_pages.h"

namespace planetree::cache {
namespace {

constexpr CacheLimits kUsual{0, 500, 4096, 4, 10000};

TEST(CacheLimits, MinimumIsOneFrameForEachLimboEntryAndOneForTheRoot) {
  EXPECT_EQ(minimum_frame_count({0, 500, 4096, 4, 0}), 6u);
  EXPECT_EQ(minimum_frame_count({0, 6, 4096, 4, 0}), 6u);
  EXPECT_EQ(minimum_frame_count({0, 5, 4096, 4, 0}), 5u);
  EXPECT_EQ(minimum_frame_count({0, 1, 4096, 4, 0}), 1u);
}

TEST(CacheLimits, MinimumBudgetCountsFramesTablesAndReserve) {
  // Frames, map, slots, stamps and reserve must all be counted.
  EXPECT_GE(minimum_budget_bytes(kUsual), 6u * 4096 + 500 * 4 + 4 * 64 + 5 * 4 * 8 + 10000);
  CacheLimits more = kUsual;
  more.reserved_bytes += 1;
  EXPECT_EQ(minimum_budget_bytes(more), minimum_budget_bytes(kUsual) + 1);
  more = kUsual;
  more.page_count += 1'000'000;
  EXPECT_GE(minimum_budget_bytes(more), minimum_budget_bytes(kUsual) + 4'000'000);
}

TEST(CacheLimits, FrameCountIsTheLargestThatFitsTheBudget) {
  CacheLimits limits = kUsual;
  std::uint32_t last = 0;
  for (limits.budget_bytes = 0; limits.budget_bytes < 2'200'000; limits.budget_bytes += 997) {
    const std::uint32_t frames = frames_within_budget(limits);
    EXPECT_GE(frames, last);
    last = frames;
    if (frames > 0) {
      ASSERT_LE(bytes_needed(limits, frames), limits.budget_bytes);
    }
    if (frames < limits.page_count) {
      ASSERT_GT(bytes_needed(limits, frames + 1), limits.budget_bytes);
    }
  }
  EXPECT_EQ(last, limits.page_count);
}

TEST(CacheLimits, BytesNeededSaturatesAtHugeLimits) {
  CacheLimits limits{std::numeric_limits<std::uint64_t>::max(), 0xfffffffeu, kMaxFrameBytes,
                     kMaxReaders, std::numeric_limits<std::uint64_t>::max()};
  EXPECT_EQ(minimum_budget_bytes(limits), std::numeric_limits<std::uint64_t>::max());
  limits.reserved_bytes = 0;
  EXPECT_EQ(frames_within_budget(limits), limits.page_count);
  EXPECT_GT(bytes_needed(limits, limits.page_count), std::uint64_t{0xfffffffe} * kMaxFrameBytes);
}

TEST(CacheLimits, RefusesLimitsOutOfRange) {
  const auto code_of = [](const CacheLimits& limits) {
    TaggedPages pages;
    const auto cache = PageCache::create(limits, TaggedPages::fill, &pages);
    return cache ? ErrorCode{} : cache.error().code;
  };
  CacheLimits good = kUsual;
  good.budget_bytes = minimum_budget_bytes(good);
  EXPECT_EQ(code_of(good), ErrorCode{});
  for (auto field :
       {&CacheLimits::page_count, &CacheLimits::frame_bytes, &CacheLimits::max_readers}) {
    for (const std::uint32_t value : {0u, 0xffffffffu}) {
      CacheLimits bad = good;
      bad.*field = value;
      EXPECT_EQ(code_of(bad), ErrorCode::kBadArgument);
    }
  }
}

TEST(CacheLimits, ErrorNamesTheMinimumBudgetWhichIsAccepted) {
  for (const std::uint32_t page_count : {1u, 3u, 6u, 7u, 500u}) {
    TaggedPages pages;
    CacheLimits limits = kUsual;
    limits.page_count = page_count;
    const std::uint64_t minimum = minimum_budget_bytes(limits);
    for (const std::uint64_t budget : {std::uint64_t{0}, minimum / 2, minimum - 1}) {
      limits.budget_bytes = budget;
      const auto refused = PageCache::create(limits, TaggedPages::fill, &pages);
      ASSERT_FALSE(refused);
      EXPECT_EQ(refused.error().code, ErrorCode::kNoMemory);
      EXPECT_NE(std::strstr(refused.error().text, std::to_string(minimum).c_str()), nullptr)
          << refused.error().text;
    }
    limits.budget_bytes = minimum;
    const auto cache = PageCache::create(limits, TaggedPages::fill, &pages);
    ASSERT_TRUE(cache);
    EXPECT_EQ((*cache)->stats().frame_count, std::min(page_count, 6u));
  }
}

}  // namespace
}  // namespace planetree::cache
