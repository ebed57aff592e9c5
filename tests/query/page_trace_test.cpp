// Page traces of real-time queries, without threads or clocks.

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "planetree/probe.h"
#include "query/model_state.h"
#include "tests/query/fetch_steps.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

using Kind = PageAccess::Kind;
using AccessRow = std::tuple<std::uint64_t, std::uint32_t, std::uint32_t, unsigned, Kind>;

FetchWorker::Seconds no_time() { return FetchWorker::Seconds(0); }

class PageTraceTest : public testing::Test {
 protected:
  PageTraceTest() : sample_(SampleModel::masked(octree::sphere(5))) {}

  Model open(std::uint32_t page_trace_capacity,
             std::uint64_t budget_bytes = std::uint64_t{64} << 20) {
    OpenOptions options;
    options.max_probes = 2;  // one of them for the worker
    options.memory_budget_bytes = budget_bytes;
    options.page_trace_capacity = page_trace_capacity;
    auto model =
        ModelState::open_model(sample_.path(), options, {storage::FileCalls::real(), false});
    EXPECT_TRUE(model);
    return *std::move(model);
  }

  FetchWorker worker_of(const Model& model) const {
    const ModelState& state = ModelState::of(model);
    return fetch_worker(state, &no_time, never_);
  }

  static std::vector<PageAccess> take_all(const Model& model) {
    std::vector<PageAccess> all(1 << 16);
    all.resize(model.drain_page_trace(all));
    return all;
  }

  static ClosestPoint real_time_answer(Probe& probe, const Vec3& point) {
    return probe.closest_point(point, {.wait = Wait::kNever});
  }

  // Moves a probe and queries, while a worker fetches the pages that it misses and those along its
  // motion.
  std::vector<AccessRow> wander(std::uint64_t more_bytes) {
    const Model model = open(4096, min_budget_with(4096) + more_bytes);
    FetchWorker worker = worker_of(model);
    Probe probe = make_probe(model);
    std::vector<AccessRow> rows;
    for (const Vec3& point : random_queries(200, -1.2, 1.2, 3)) {
      probe.motion(point, {point.y, point.z, point.x});
      (void)real_time_answer(probe, point);
      worker.work();
      for (const PageAccess& access : take_all(model))
        rows.emplace_back(access.query, access.probe, access.page, access.level, access.kind);
    }
    EXPECT_EQ(model.stats().page_trace_dropped, 0u);
    return rows;
  }

  std::uint64_t min_budget_with(std::uint32_t accesses) const {
    return sample_.min_budget(2) + 4 * std::uint64_t{accesses} * 16;
  }

  SampleModel sample_;
  const std::atomic<bool> never_{false};
};

TEST_F(PageTraceTest, SameRunGivesTheSameTrace) {
  const std::vector<AccessRow> rows = wander(0);
  EXPECT_GT(rows.size(), 400u);
  EXPECT_EQ(wander(0), rows);
  EXPECT_NE(wander(40 * 4096), rows);
}

// Nothing is evicted here, so a page that was hit is never missed later. Hits and misses agree with
// the counts of the model's cache.
TEST_F(PageTraceTest, HitsAndMissesAgreeWithTheCache) {
  const Model model = open(4096);
  FetchWorker worker = worker_of(model);
  Probe probe = make_probe(model);
  std::set<std::uint32_t> resident;
  std::uint64_t all_misses = 0, queries = 0;
  for (const Vec3& point : random_queries(100, -1.2, 1.2, 3)) {
    const Stats before = model.stats();
    const ClosestPoint answer = real_time_answer(probe, point);
    const Stats after = model.stats();
    std::uint64_t hits = 0, misses = 0;
    for (const PageAccess& access : take_all(model)) {
      EXPECT_EQ(access.query, queries);
      ++(access.kind == Kind::kMissed ? misses : hits);
      if (access.kind != Kind::kMissed) resident.insert(access.page);
      EXPECT_FALSE(access.kind == Kind::kMissed && resident.contains(access.page));
    }
    EXPECT_EQ(hits, after.page_hits - before.page_hits);
    EXPECT_EQ(misses, after.page_misses - before.page_misses);
    EXPECT_TRUE(misses > 0 || answer.status == Status::kExact);
    all_misses += misses;
    ++queries;
    worker.work();
  }
  EXPECT_GT(all_misses, 20u);
  EXPECT_GT(resident.size(), 20u);
  EXPECT_GE(model.stats().pages_read, resident.size());
}

TEST_F(PageTraceTest, DistinguishesPrefetchedPages) {
  const Model model = open(4096);
  FetchWorker worker = worker_of(model);
  Probe probe = make_probe(model);
  probe.motion({-1.2, 0, 0}, {2.4 / 0.005, 0, 0});
  while (worker.work() == FetchWorker::Action::kPrefetchedPosition) {
  }
  std::map<Kind, int> counts[2];
  std::set<std::uint32_t> seen_pages;
  for (auto& count : counts) {
    (void)real_time_answer(probe, {1.2, 0, 0});
    for (const PageAccess& access : take_all(model)) {
      ++count[access.kind];
      const bool again = !seen_pages.insert(access.page).second;
      EXPECT_TRUE(access.kind == Kind::kHit || !again);
    }
  }
  EXPECT_GT(counts[0][Kind::kPrefetched], 0);
  EXPECT_EQ(counts[0][Kind::kMissed], 0);
  EXPECT_EQ(counts[1][Kind::kMissed], 0);
  EXPECT_GT(counts[1][Kind::kHit], 0);
}

TEST_F(PageTraceTest, RecordsTheLevelsOfPages) {
  const Model model = open(4096);
  Probe probe = make_probe(model);
  for (const Vec3& point : random_queries(50, -1.2, 1.2)) {
    (void)probe.closest_point(point);  // blocking, so not traced
    (void)real_time_answer(probe, point);
  }
  std::map<std::uint32_t, unsigned> levels;  // by page
  for (const PageAccess& access : take_all(model)) {
    levels.emplace(access.page, access.level);
    EXPECT_EQ(levels[access.page], access.level);
    EXPECT_LT(access.query, 50u);
  }
  // Pages are ordered by their keys, coarse cells first.
  unsigned last = 0;
  for (const auto& [page, level] : levels) {
    if (page >= sample_.page_count()) break;  // pages of the mask have an order of their own
    EXPECT_GE(level, last);
    last = level;
  }
  EXPECT_GT(last, levels.begin()->second);
}

TEST_F(PageTraceTest, CountsRecordsDroppedWhenTheRingIsFull) {
  const std::vector<Vec3> points = random_queries(100, -1.2, 1.2);
  std::uint64_t all = 0;
  for (const std::uint32_t accesses : {4096u, 50u}) {
    const Model model = open(accesses);
    Probe probe = make_probe(model);
    for (const Vec3& point : points) (void)real_time_answer(probe, point);
    const std::size_t kept = take_all(model).size();
    if (accesses == 4096) all = kept;
    EXPECT_EQ(kept + model.stats().page_trace_dropped, all);
    if (accesses == 50) {
      EXPECT_EQ(kept, 64u);
    }
  }
  EXPECT_GT(all, 64u);
}

TEST_F(PageTraceTest, DrainsAsManyRecordsAsFit) {
  const Model model = open(4096);
  Probe probe = make_probe(model);
  for (const Vec3& point : random_queries(100, -1.2, 1.2)) (void)real_time_answer(probe, point);
  std::vector<PageAccess> few(70);
  ASSERT_EQ(model.drain_page_trace(few), 70u);
  EXPECT_EQ(few[0].query, 0u);
  const std::uint64_t last = few.back().query;
  ASSERT_GE(model.drain_page_trace(few), 1u);
  EXPECT_GE(few[0].query, last);
}

TEST_F(PageTraceTest, UsesNoMemoryUnlessEnabled) {
  const Model off = open(0), on = open(1000);
  Probe probe = make_probe(off);
  (void)real_time_answer(probe, {0, 1.1, 0.3});
  EXPECT_TRUE(take_all(off).empty());
  EXPECT_GE(on.stats().table_bytes, off.stats().table_bytes + 3 * 1024 * sizeof(TracedAccess));
}

TEST_F(PageTraceTest, RefusesACapacityOutOfRange) {
  OpenOptions options;
  options.page_trace_capacity = OpenOptions::kMaxPageTraceCapacity + 1;
  const auto model = Model::open(sample_.path(), options);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::kBadArgument);
}

}  // namespace
}  // namespace planetree::query
