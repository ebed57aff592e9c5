#include "tools/tune/trace_analysis.h"

#include <gtest/gtest.h>

#include "tests/tools/tune/made_accesses.h"

namespace planetree::tools {
namespace {

using Event = PageAccess::Event;
using Query = PageAccess::Query;

std::vector<std::uint32_t> pages_of(const References& references) {
  std::vector<std::uint32_t> pages;
  for (const std::uint32_t number : references.stored())
    pages.push_back(references.pages()[number].file_page);
  return pages;
}

TEST(TraceAnalysis, TakesTheLookupsOfQueriesAndOfOpen) {
  TraceAnalysis analysis;
  analysis.add(own(Query::kOpen, 4, Event::kFetched));
  analysis.add(own(Query::kOpen, 4, Event::kInstalled));
  analysis.add(lookup(0, 4, Event::kHit));
  analysis.add(lookup(0, 5, Event::kFetched));
  analysis.add(own(Query::kFetch, 6, Event::kFetched));
  analysis.add(own(Query::kPrefetch, 7, Event::kHit));
  analysis.add(lookup(1, 8, Event::kPrefetched));
  EXPECT_EQ(pages_of(analysis.references()), (std::vector<std::uint32_t>{4, 4, 5, 8}));
  EXPECT_EQ(analysis.references().opening(), 1u);
  EXPECT_EQ(analysis.references().lookups(), 3u);
  EXPECT_EQ(analysis.queries(), 2u);
  EXPECT_EQ(analysis.misses(), 1u);
}

TEST(TraceAnalysis, TakesMissesOfQueriesThatDoNotWaitIfTheyWereNeeded) {
  TraceAnalysis analysis;
  PageAccess missed = lookup(0, 3, Event::kMissed);
  analysis.add(missed);
  missed.page = 4;
  missed.needed = true;
  analysis.add(missed);
  missed.page = 5;
  missed.event = Event::kLate;
  analysis.add(missed);
  EXPECT_EQ(pages_of(analysis.references()), (std::vector<std::uint32_t>{4, 5}));
  EXPECT_EQ(analysis.misses(), 2u);
}

TEST(TraceAnalysis, CountsQueriesWithoutLookups) {
  TraceAnalysis analysis;
  analysis.add(lookup(2, 3, Event::kHit));
  analysis.add(lookup(2, 4, Event::kHit));
  PageAccess other = lookup(0, 5, Event::kHit);
  other.probe = 1;
  analysis.add(other);
  PageAccess degraded = lookup(4, 0, Event::kDegraded);
  analysis.add(degraded);
  EXPECT_EQ(analysis.queries(), 6u);
  EXPECT_EQ(analysis.degraded(), 1u);
  EXPECT_EQ(std::vector(analysis.references().query_begins().begin(),
                        analysis.references().query_begins().end()),
            (std::vector<std::uint32_t>{0, 0, 0, 2, 3, 3}));
}

TEST(TraceAnalysis, KeepsTheMotionsOfTheProbeThatHasMost) {
  TraceAnalysis analysis;
  for (std::uint32_t i = 0; i < 5; ++i) {
    PageAccess motion = lookup(i, 0, Event::kMotion, i);
    motion.probe = i % 3 == 0 ? 1 : 2;
    motion.position = {static_cast<double>(i), 0, 0};
    analysis.add(motion);
  }
  ASSERT_EQ(analysis.motions().size(), 3u);
  EXPECT_EQ(analysis.motions()[1].position.x, 2);
  EXPECT_EQ(analysis.motions()[2].time_ns, 4u);
  EXPECT_TRUE(TraceAnalysis().motions().empty());
}

TEST(TraceAnalysis, TellsHowGoodPrefetchWas) {
  TraceAnalysis analysis;
  for (std::uint32_t page = 1; page <= 10; ++page)
    analysis.add(own(Query::kPrefetch, page, Event::kInstalled));
  for (std::uint32_t page = 1; page <= 6; ++page)
    analysis.add(lookup(page, page, Event::kPrefetched));
  for (std::uint32_t page = 8; page <= 9; ++page)
    analysis.add(own(Query::kFetch, page, Event::kEvictedUnused));
  PageAccess missed = lookup(10, 20, Event::kMissed);
  analysis.add(missed);  // not needed
  missed.needed = true;
  analysis.add(missed);
  missed.event = Event::kLate;
  missed.page = 21;
  analysis.add(missed);
  const PrefetchFigures& figures = analysis.prefetch();
  EXPECT_EQ(figures.read, 10u);
  EXPECT_DOUBLE_EQ(figures.accuracy(), 0.6);
  EXPECT_DOUBLE_EQ(figures.coverage(), 6.0 / 8);
  EXPECT_DOUBLE_EQ(figures.timeliness(), 6.0 / 7);
  EXPECT_DOUBLE_EQ(figures.waste(), 0.2);
  EXPECT_EQ(analysis.evictions(), 2u);
  EXPECT_EQ(PrefetchFigures().accuracy(), 0);
}

}  // namespace
}  // namespace planetree::tools
