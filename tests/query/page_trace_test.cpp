// The trace of what asks that do not wait looked for: without threads or clocks.

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "planetree/probe.h"
#include "query/model_state.h"
#include "query/serve/fetch_worker.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

using Kind = PageTouch::Kind;
using TouchRow = std::tuple<std::uint64_t, std::uint32_t, std::uint32_t, unsigned, Kind>;

FetchWorker::Seconds no_time() { return FetchWorker::Seconds(0); }

class PageTouches : public testing::Test {
 protected:
  PageTouches() : sample_(SampleModel::masked(octree::sphere(5))) {}

  Model open(std::uint32_t trace_touches, std::uint64_t budget_bytes = std::uint64_t{64} << 20) {
    OpenOptions options;
    options.max_probes = 2;  // one of them for the worker
    options.memory_budget_bytes = budget_bytes;
    options.trace_touches = trace_touches;
    auto model =
        ModelState::open_model(sample_.path(), options, {storage::FileCalls::real(), false});
    EXPECT_TRUE(model);
    return *std::move(model);
  }

  FetchWorker worker_of(const Model& model) const {
    const ModelState& state = ModelState::of(model);
    return {state, *state.claim_reader(), 0, 1, &no_time, never_};
  }

  static std::vector<PageTouch> take_all(const Model& model) {
    std::vector<PageTouch> all(1 << 16);
    all.resize(model.take_touches(all));
    return all;
  }

  static ClosestPoint ask(Probe& probe, const Vec3& place) {
    return probe.closest_point(place, {.wait = Wait::kNever});
  }

  // A tip that wanders, while a worker gets what it misses and where it goes.
  std::vector<TouchRow> wander(std::uint64_t more_bytes) {
    const Model model = open(4096, least_budget_with(4096) + more_bytes);
    FetchWorker worker = worker_of(model);
    Probe probe = make_probe(model);
    std::vector<TouchRow> rows;
    for (const Vec3& place : random_queries(200, -1.2, 1.2, 3)) {
      probe.motion(place, {place.y, place.z, place.x});
      (void)ask(probe, place);
      worker.work();
      for (const PageTouch& touch : take_all(model))
        rows.emplace_back(touch.ask, touch.probe, touch.page, touch.level, touch.kind);
    }
    EXPECT_EQ(model.stats().touches_dropped, 0u);
    return rows;
  }

  std::uint64_t least_budget_with(std::uint32_t touches) const {
    return sample_.least_budget(2) + 4 * std::uint64_t{touches} * 16;
  }

  SampleModel sample_;
  const std::atomic<bool> never_{false};
};

TEST_F(PageTouches, AreTheSameOfTheSameRun) {
  const std::vector<TouchRow> rows = wander(0);
  EXPECT_GT(rows.size(), 400u);
  EXPECT_EQ(wander(0), rows);
  EXPECT_NE(wander(40 * 4096), rows);
}

// Where nothing is evicted, a cache that is fed the hits of the trace says which pages can be
// missed; and the counts are those of the model's own cache.
TEST_F(PageTouches, ReplayToWhatTheCacheCounted) {
  const Model model = open(4096);
  FetchWorker worker = worker_of(model);
  Probe probe = make_probe(model);
  std::set<std::uint32_t> resident;
  std::uint64_t all_misses = 0, asks = 0;
  for (const Vec3& place : random_queries(100, -1.2, 1.2, 3)) {
    const Stats before = model.stats();
    const ClosestPoint answer = ask(probe, place);
    const Stats after = model.stats();
    std::uint64_t hits = 0, misses = 0;
    for (const PageTouch& touch : take_all(model)) {
      EXPECT_EQ(touch.ask, asks);
      ++(touch.kind == Kind::kMissed ? misses : hits);
      if (touch.kind != Kind::kMissed) resident.insert(touch.page);
      EXPECT_FALSE(touch.kind == Kind::kMissed && resident.contains(touch.page));
    }
    EXPECT_EQ(hits, after.page_hits - before.page_hits);
    EXPECT_EQ(misses, after.page_misses - before.page_misses);
    EXPECT_TRUE(misses > 0 || answer.status == Status::kExact);
    all_misses += misses;
    ++asks;
    worker.work();
  }
  EXPECT_GT(all_misses, 20u);
  EXPECT_GT(resident.size(), 20u);
  EXPECT_GE(model.stats().pages_read, resident.size());
}

TEST_F(PageTouches, TellPagesThatCameAheadOfTheirTime) {
  const Model model = open(4096);
  FetchWorker worker = worker_of(model);
  Probe probe = make_probe(model);
  probe.motion({-1.2, 0, 0}, {2.4 / 0.005, 0, 0});
  while (worker.work() == FetchWorker::Did::kLookedAhead) {
  }
  std::map<Kind, int> counts[2];
  std::set<std::uint32_t> touched;
  for (auto& count : counts) {
    (void)ask(probe, {1.2, 0, 0});
    for (const PageTouch& touch : take_all(model)) {
      ++count[touch.kind];
      const bool again = !touched.insert(touch.page).second;
      EXPECT_TRUE(touch.kind == Kind::kHit || !again);
    }
  }
  EXPECT_GT(counts[0][Kind::kPrefetched], 0);
  EXPECT_EQ(counts[0][Kind::kMissed], 0);
  EXPECT_EQ(counts[1][Kind::kMissed], 0);
  EXPECT_GT(counts[1][Kind::kHit], 0);
}

TEST_F(PageTouches, TellTheLevelsOfPages) {
  const Model model = open(4096);
  Probe probe = make_probe(model);
  for (const Vec3& place : random_queries(50, -1.2, 1.2)) {
    (void)probe.closest_point(place);  // waits, and is not traced
    (void)ask(probe, place);
  }
  std::map<std::uint32_t, unsigned> levels;  // of pages
  for (const PageTouch& touch : take_all(model)) {
    levels.emplace(touch.page, touch.level);
    EXPECT_EQ(levels[touch.page], touch.level);
    EXPECT_LT(touch.ask, 50u);
  }
  // Pages are in the order of their keys, coarse cells first.
  unsigned last = 0;
  for (const auto& [page, level] : levels) {
    if (page >= sample_.page_count()) break;  // the mask has an order of its own
    EXPECT_GE(level, last);
    last = level;
  }
  EXPECT_GT(last, levels.begin()->second);
}

TEST_F(PageTouches, AreDroppedAndCountedWhereNobodyTakesThem) {
  const std::vector<Vec3> places = random_queries(100, -1.2, 1.2);
  std::uint64_t all = 0;
  for (const std::uint32_t touches : {4096u, 50u}) {
    const Model model = open(touches);
    Probe probe = make_probe(model);
    for (const Vec3& place : places) (void)ask(probe, place);
    const std::size_t kept = take_all(model).size();
    if (touches == 4096) all = kept;
    EXPECT_EQ(kept + model.stats().touches_dropped, all);
    if (touches == 50) {
      EXPECT_EQ(kept, 64u);
    }
  }
  EXPECT_GT(all, 64u);
}

TEST_F(PageTouches, AreTakenAsFarAsThereIsRoom) {
  const Model model = open(4096);
  Probe probe = make_probe(model);
  for (const Vec3& place : random_queries(100, -1.2, 1.2)) (void)ask(probe, place);
  std::vector<PageTouch> few(70);
  ASSERT_EQ(model.take_touches(few), 70u);
  EXPECT_EQ(few[0].ask, 0u);
  const std::uint64_t last = few.back().ask;
  ASSERT_GE(model.take_touches(few), 1u);
  EXPECT_GE(few[0].ask, last);
}

TEST_F(PageTouches, TakeNoMemoryUnlessWanted) {
  const Model off = open(0), on = open(1000);
  Probe probe = make_probe(off);
  (void)ask(probe, {0, 1.1, 0.3});
  EXPECT_TRUE(take_all(off).empty());
  EXPECT_GE(on.stats().table_bytes, off.stats().table_bytes + 3 * 1024 * sizeof(Touch));
}

TEST_F(PageTouches, RefuseToBeTooMany) {
  OpenOptions options;
  options.trace_touches = OpenOptions::kMostTraceTouches + 1;
  const auto model = Model::open(sample_.path(), options);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::kBadArgument);
}

}  // namespace
}  // namespace planetree::query
