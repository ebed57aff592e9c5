#include "tools/tune/trace_timeline.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/tools/tune/made_accesses.h"

namespace planetree::tools {
namespace {

using Event = PageAccess::Event;
constexpr std::uint64_t kMs = 1'000'000;

TEST(TraceTimeline, JoinsWindowsWhenATraceIsLong) {
  TraceTimeline timeline;
  // One lookup a millisecond for 1000 ms, of 10 pages in turn for 100 ms each.
  for (std::uint32_t ms = 0; ms < 1000; ++ms)
    timeline.add(lookup(ms, 100 + ms / 100, Event::kHit, ms * kMs));
  EXPECT_EQ(timeline.window_ns(), 16 * kMs);
  EXPECT_EQ(timeline.windows().size(), 63u);
  std::uint64_t lookups = 0;
  for (const auto& window : timeline.windows()) lookups += window.lookups;
  EXPECT_EQ(lookups, 1000u);
  EXPECT_EQ(timeline.windows()[0].looked_up.size(), 1u);
  EXPECT_EQ(timeline.windows()[6].looked_up.size(), 2u) << "from 96 ms to 112 ms";
  EXPECT_TRUE(timeline.windows()[6].looked_up.contains(101));
}

TEST(TraceTimeline, KnowsWhichPagesAreInMemory) {
  TraceTimeline timeline;
  timeline.add(lookup(0, 1, Event::kInstalled, 0));
  timeline.add(lookup(0, 2, Event::kInstalled, kMs));
  timeline.add(lookup(0, 1, Event::kEvicted, 3 * kMs));
  timeline.add(lookup(0, 2, Event::kHit, 5 * kMs));
  std::vector<std::size_t> sizes;
  for (const auto& window : timeline.windows()) sizes.push_back(window.resident.size());
  EXPECT_EQ(sizes, (std::vector<std::size_t>{1, 2, 2, 2, 1, 1}));
}

TEST(TraceTimeline, CountsMissesThatWereNeededAndDegradedAnswers) {
  TraceTimeline timeline;
  timeline.add(lookup(0, 1, Event::kMissed));
  timeline.add(lookup(0, 1, Event::kFetched));
  timeline.add(own(PageAccess::Query::kFetch, 1, Event::kFetched));
  timeline.add(lookup(0, 0, Event::kDegraded));
  ASSERT_EQ(timeline.windows().size(), 1u);
  EXPECT_EQ(timeline.windows()[0].lookups, 2u);
  EXPECT_EQ(timeline.windows()[0].misses, 1u);
  EXPECT_EQ(timeline.windows()[0].degraded, 1u);
}

TEST(TraceTimeline, OrdersPagesBySectionAndOctcode) {
  TraceTimeline timeline;
  // Pages 10 to 13: their octcodes descend, and page 13 is of the mask.
  for (std::uint32_t page = 10; page < 14; ++page) {
    PageAccess access = lookup(page, page, Event::kHit, (page - 10) * kMs);
    access.octcode = 20 - page;
    if (page == 13) access.section = PageAccess::Section::kMask;
    timeline.add(access);
  }
  EXPECT_EQ(timeline.rows(100), 4u);
  const auto each = timeline.shares(&TraceTimeline::Window::looked_up, 100);
  ASSERT_EQ(each.size(), 16u);
  // Rows from the least octcode: pages 12, 11, 10, and then 13.
  for (const unsigned at : {0U * 4 + 2, 1U * 4 + 1, 2U * 4 + 0, 3U * 4 + 3}) EXPECT_EQ(each[at], 1);
  EXPECT_EQ(std::accumulate(each.begin(), each.end(), 0.0F), 4);
  const auto pairs = timeline.shares(&TraceTimeline::Window::looked_up, 2);
  ASSERT_EQ(pairs.size(), 8u);
  EXPECT_EQ(pairs[1], 0.5F);
}

}  // namespace
}  // namespace planetree::tools
