// Page traces that are full, and the memory that they take.

#include <gtest/gtest.h>

#include <vector>

#include "tests/query/trace/page_trace_fixture.h"

namespace planetree::query {
namespace {

using PageTraceLosses = PageTraceTest;

TEST_F(PageTraceLosses, CountsRecordsDroppedWhenTheRingIsFull) {
  const std::vector<Vec3> points = random_queries(100, -1.2, 1.2);
  std::uint64_t all = 0;
  for (const std::uint32_t words : {kCapacity, 50u}) {
    const Model model = open(words);
    Probe probe = make_probe(model);
    take_all(model);
    for (const Vec3& point : points) (void)real_time_answer(probe, point);
    const std::vector<PageAccess> kept = take_all(model);
    if (words == kCapacity) all = kept.size();
    EXPECT_EQ(kept.size() + model.stats().page_trace_dropped, all);
    if (words == kCapacity) continue;
    EXPECT_LE(kept.size(), 62u);  // the time and the number of the first query take two words
    EXPECT_GT(kept.size(), 30u);
    // The records go on with the next query, whose number tells how many are missing.
    (void)real_time_answer(probe, points[0]);
    const std::vector<PageAccess> rest = take_all(model);
    ASSERT_FALSE(rest.empty());
    EXPECT_EQ(rest[0].query, points.size());
    EXPECT_EQ(model.stats().page_trace_dropped, all - kept.size());
  }
  EXPECT_GT(all, 64u);
}

TEST_F(PageTraceLosses, BeginsWithTheWholeOpeningOrNothingOfIt) {
  const Model whole = open(kCapacity);
  std::size_t of_open = 0;
  for (const PageAccess& access : take_all(whole))
    of_open += access.query_kind == PageAccess::Query::kOpen;
  EXPECT_GT(of_open, 64u);
  const Model none = open(64);
  EXPECT_TRUE(take_all(none).empty());
  EXPECT_EQ(none.stats().page_trace_dropped, 0u);
}

TEST_F(PageTraceLosses, DrainsAsManyRecordsAsFit) {
  const Model model = open(kCapacity);
  Probe probe = make_probe(model);
  take_all(model);
  for (const Vec3& point : random_queries(100, -1.2, 1.2)) (void)real_time_answer(probe, point);
  std::vector<PageAccess> few(70);
  ASSERT_EQ(model.drain_page_trace(few), 70u);
  EXPECT_EQ(few[0].query, 0u);
  const std::uint64_t last = few.back().query;
  ASSERT_GE(model.drain_page_trace(few), 1u);
  EXPECT_GE(few[0].query, last);
}

TEST_F(PageTraceLosses, UsesNoMemoryUnlessEnabled) {
  const Model off = open(0), on = open(1000);
  Probe probe = make_probe(off);
  (void)real_time_answer(probe, {0, 1.1, 0.3});
  EXPECT_TRUE(take_all(off).empty());
  EXPECT_GE(on.stats().table_bytes, off.stats().table_bytes + 3 * 1024 * sizeof(std::uint64_t));
}

TEST_F(PageTraceLosses, RefusesACapacityOutOfRange) {
  OpenOptions options;
  options.page_trace_capacity = OpenOptions::kMaxPageTraceCapacity + 1;
  const auto model = Model::open(sample_.path(), options);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::kBadArgument);
}

}  // namespace
}  // namespace planetree::query
