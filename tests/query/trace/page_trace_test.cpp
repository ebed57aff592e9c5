// Page traces, without threads or clocks.

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "tests/query/trace/page_trace_fixture.h"

namespace planetree::query {
namespace {

using Event = PageAccess::Event;
using Query = PageAccess::Query;
using AccessRow = std::tuple<std::uint64_t, std::uint64_t, std::uint32_t, std::uint32_t, unsigned,
                             Query, Event, bool>;

bool is_lookup(Event event) { return event <= Event::kFetched; }
bool is_miss(Event event) { return event == Event::kMissed || event == Event::kLate; }

TEST_F(PageTraceTest, SameRunGivesTheSameTrace) {
  const auto wander_rows = [this](std::uint64_t more_frames) {
    std::vector<AccessRow> rows;
    for (const PageAccess& access : wander(open_small(more_frames)))
      rows.emplace_back(access.time_ns, access.query, access.probe, access.page, access.level,
                        access.query_kind, access.event, access.needed);
    return rows;
  };
  const std::vector<AccessRow> rows = wander_rows(0);
  EXPECT_GT(rows.size(), 400u);
  EXPECT_EQ(wander_rows(0), rows);
  EXPECT_NE(wander_rows(40), rows);
}

// The pages that are in memory by the records of pages read and evicted explain each lookup.
TEST_F(PageTraceTest, LookupsFollowFromPagesReadAndEvicted) {
  const Model model = open_small(8);  // with fewer frames nothing is prefetched
  std::vector<PageAccess> all = wander(model);
  Probe probe = make_probe(model);
  const std::vector<Vec3> points = random_queries(60, -1.2, 1.2, 7);
  std::vector<ClosestPoint> answers(points.size());
  probe.closest_points(points, answers);
  for (const Vec3& point : points) (void)probe.contains(point);
  const std::vector<PageAccess> taken = take_all(model);
  all.insert(all.end(), taken.begin(), taken.end());
  std::set<std::uint32_t> resident;
  std::map<Event, std::uint64_t> counts;
  std::uint64_t time = 0;
  for (const PageAccess& access : all) {
    ++counts[access.event];
    EXPECT_GE(access.time_ns, time);
    time = access.time_ns;
    if (is_lookup(access.event)) {
      EXPECT_EQ(resident.contains(access.page),
                access.event == Event::kHit || access.event == Event::kPrefetched);
    } else if (access.event == Event::kInstalled) {
      EXPECT_TRUE(resident.insert(access.page).second);
    } else if (access.event == Event::kEvicted || access.event == Event::kEvictedUnused) {
      EXPECT_EQ(resident.erase(access.page), 1u);
    }
  }
  const Stats stats = model.stats();
  EXPECT_EQ(counts[Event::kInstalled], stats.pages_read);
  EXPECT_EQ(counts[Event::kEvicted] + counts[Event::kEvictedUnused], stats.pages_evicted);
  EXPECT_EQ(counts[Event::kHit] + counts[Event::kPrefetched], stats.page_hits);
  EXPECT_EQ(counts[Event::kMissed] + counts[Event::kLate] + counts[Event::kFetched],
            stats.page_misses);
  EXPECT_EQ(counts[Event::kMotion], 200u);
  EXPECT_EQ(counts[Event::kDegraded], stats.degraded_answers);
  EXPECT_GT(counts[Event::kEvictedUnused], 0u);
  EXPECT_GT(counts[Event::kFetched], 100u);
}

TEST_F(PageTraceTest, TellsTheKindsOfQueries) {
  const Model model = open(kCapacity);
  const std::vector<Vec3> points = random_queries(60, -1.2, 1.2, 7);
  std::vector<Containment> answers(points.size());
  std::vector<ClosestPoint> closest(points.size());
  const auto expect = [&](Query kind, bool in_batch, bool waits) {
    const std::vector<PageAccess> taken = take_queries(model);
    EXPECT_GT(taken.size(), 0u);
    for (const PageAccess& access : taken) {
      EXPECT_EQ(access.query_kind, kind);
      EXPECT_EQ(access.in_batch, in_batch);
      EXPECT_EQ(access.waits, waits);
      EXPECT_LT(access.query, points.size());
    }
  };
  const auto each = [&](auto&& query) {
    Probe probe = make_probe(model);
    take_all(model);
    query(probe);
  };
  each([&](Probe& probe) { probe.closest_points(points, closest); });
  expect(Query::kClosestPoint, true, true);
  const QueryOptions now{.wait = Wait::kNever};
  EXPECT_TRUE(take_all(model).empty());
  each([&](Probe& probe) { (void)probe.closest_point(points[0], now); });
  const std::vector<PageAccess> one = take_all(model);
  ASSERT_FALSE(one.empty());
  EXPECT_EQ(one[0].query, points.size());  // the sequence of an index goes on
  EXPECT_FALSE(one[0].in_batch || one[0].waits);
}

TEST_F(PageTraceTest, RecordsContainmentAndFrontsAsSuch) {
  const Model model = open(kCapacity);
  Probe probe = make_probe(model);
  for (const SideRule rule : {SideRule::kSolid, SideRule::kSurface}) {
    take_all(model);
    for (const Vec3& point : random_queries(200, -1.01, 1.01, 7))
      (void)probe.contains(point, {.wait = Wait::kNever, .side_rule = rule});
    const std::vector<PageAccess> taken = take_queries(model);
    EXPECT_GT(taken.size(), 0u);
    for (const PageAccess& access : taken) EXPECT_EQ(access.query_kind, Query::kContains);
  }
}

// Nothing is evicted here, so a page that was hit is never missed later. Hits and misses agree with
// the counts of the model's cache.
TEST_F(PageTraceTest, HitsAndMissesAgreeWithTheCache) {
  const Model model = open(kCapacity);
  FetchWorker worker = worker_of(model);
  Probe probe = make_probe(model);
  take_all(model);
  std::set<std::uint32_t> resident;
  std::uint64_t all_misses = 0, queries = 0;
  for (const Vec3& point : random_queries(100, -1.2, 1.2, 3)) {
    const Stats before = model.stats();
    const ClosestPoint answer = real_time_answer(probe, point);
    const Stats after = model.stats();
    std::uint64_t hits = 0, misses = 0;
    for (const PageAccess& access : take_all(model)) {
      EXPECT_EQ(access.query, queries);
      EXPECT_EQ(access.event == Event::kDegraded, !is_lookup(access.event));
      if (!is_lookup(access.event)) continue;
      ++(is_miss(access.event) ? misses : hits);
      if (!is_miss(access.event)) resident.insert(access.page);
      EXPECT_FALSE(is_miss(access.event) && resident.contains(access.page));
    }
    EXPECT_EQ(hits, after.page_hits - before.page_hits);
    EXPECT_EQ(misses, after.page_misses - before.page_misses);
    EXPECT_TRUE(misses > 0 || answer.status == Status::kExact);
    all_misses += misses;
    ++queries;
    worker.work();
    take_all(model);
  }
  EXPECT_GT(all_misses, 20u);
  EXPECT_GT(resident.size(), 20u);
  EXPECT_GE(model.stats().pages_read, resident.size());
}

// Reads only the pages that are marked as needed, until the answer is exact.
TEST_F(PageTraceTest, NeededPagesSufficeForAnExactAnswer) {
  const Model model = open(kCapacity);
  auto reader = ModelState::of(model).claim_reader();
  ASSERT_TRUE(reader);
  std::uint64_t unneeded = 0, needed = 0;
  for (const Vec3& point : random_queries(100, -1.2, 1.2, 5)) {
    for (int rounds = 0;; ++rounds) {
      ASSERT_LT(rounds, 50);
      Probe probe = make_probe(model);
      take_all(model);
      const ClosestPoint answer = real_time_answer(probe, point);
      std::set<std::uint32_t> pages;
      double width = 0;
      for (const PageAccess& access : take_all(model)) {
        EXPECT_TRUE(is_miss(access.event) || !access.needed);
        if (access.needed) pages.insert(access.page);
        unneeded += is_miss(access.event) && !access.needed;
        if (access.event == Event::kDegraded) width = static_cast<double>(access.width);
      }
      needed += pages.size();
      EXPECT_EQ(pages.empty(), answer.status == Status::kExact);
      if (answer.status == Status::kExact) break;
      EXPECT_FLOAT_EQ(static_cast<float>(width), static_cast<float>(answer.upper - answer.lower));
      reader->enter();
      for (const std::uint32_t page : pages) ASSERT_NE(reader->fetch(page), nullptr);
      reader->leave();
    }
  }
  EXPECT_GT(needed, 50u);
  EXPECT_GT(unneeded, 5u);
}

TEST_F(PageTraceTest, DistinguishesPrefetchedPages) {
  const Model model = open(kCapacity);
  FetchWorker worker = worker_of(model);
  Probe probe = make_probe(model);
  take_all(model);
  probe.motion({-1.2, 0, 0}, {2.4 / 0.005, 0, 0});
  while (worker.work() == FetchWorker::Action::kPrefetchedPosition) {
  }
  std::map<Event, int> counts[2];
  std::set<std::uint32_t> seen_pages;
  for (const PageAccess& access : take_all(model))
    EXPECT_EQ(access.query_kind,
              access.event == Event::kMotion ? Query::kClosestPoint : Query::kPrefetch);
  for (auto& count : counts) {
    (void)real_time_answer(probe, {1.2, 0, 0});
    for (const PageAccess& access : take_all(model)) {
      ++count[access.event];
      const bool again = !seen_pages.insert(access.page).second;
      EXPECT_TRUE(access.event == Event::kHit || !again);
    }
  }
  EXPECT_GT(counts[0][Event::kPrefetched], 0);
  EXPECT_EQ(counts[0][Event::kMissed], 0);
  EXPECT_EQ(counts[1][Event::kMissed], 0);
  EXPECT_GT(counts[1][Event::kHit], 0);
}

TEST_F(PageTraceTest, RecordsMotionsToTheBit) {
  const Model model = open(kCapacity);
  Probe probe = make_probe(model);
  take_all(model);
  (void)real_time_answer(probe, {0, 0, 1.1});
  const Vec3 position{0.1, -1.0 / 3, 1e-300}, velocity{1e300, -0.0, 7};
  probe.motion(position, velocity);
  const std::vector<PageAccess> taken = take_all(model);
  ASSERT_GT(taken.size(), 1u);
  const PageAccess& motion = taken.back();
  EXPECT_EQ(motion.event, Event::kMotion);
  EXPECT_EQ(motion.query, 1u);
  for (const auto axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    EXPECT_EQ(motion.position.*axis, position.*axis);
    EXPECT_EQ(motion.velocity.*axis, velocity.*axis);
  }
}

TEST_F(PageTraceTest, DescribesPages) {
  const Model model = open(kCapacity);
  Probe probe = make_probe(model);
  for (const Vec3& point : random_queries(50, -1.2, 1.2)) (void)probe.closest_point(point);
  std::map<std::uint32_t, unsigned> levels;  // by page
  std::uint64_t stored_bytes = 0;
  for (const PageAccess& access : take_all(model)) {
    EXPECT_EQ(access.section, access.page < sample_.page_count() ? PageAccess::Section::kTree
                                                                 : PageAccess::Section::kMask);
    EXPECT_EQ(access.level, access.octcode >> 59);
    if (levels.emplace(access.page, access.level).second) stored_bytes += access.stored_bytes;
    EXPECT_EQ(levels[access.page], access.level);
  }
  EXPECT_GT(stored_bytes, 64u * levels.size());
  EXPECT_LE(stored_bytes, model.info().file_bytes);
  // Pages are ordered by their keys, coarse cells first.
  unsigned last = 0;
  for (const auto& [page, level] : levels) {
    if (page >= sample_.page_count()) break;  // pages of the mask have an order of their own
    EXPECT_GE(level, last);
    last = level;
  }
  EXPECT_GT(last, levels.begin()->second);
}

}  // namespace
}  // namespace planetree::query
