// Whatever delays the model's threads only delays refinement: answers still come at once, and no
// memory grows.

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <utility>
#include <vector>

#include "planetree/probe.h"
#include "query/model_state.h"
#include "tests/cache/allocation_count.h"
#include "tests/query/eventually.h"
#include "tests/query/fetch_steps.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

constexpr QueryOptions kUnhindered{.wait = Wait::kNever};

/// A disk so slow that many queries are made while it reads one page. They run on the reading
/// thread itself, so a query that waited for anything the reader holds would wait for ever.
class SlowDisk final : public storage::FileCalls {
 public:
  ssize_t pread(int descriptor, void* out, std::size_t bytes, off_t offset) noexcept override {
    if (meanwhile) meanwhile();
    return FileCalls::pread(descriptor, out, bytes, offset);
  }
  std::function<void()> meanwhile;
};

class HinderedFetching : public testing::Test {
 protected:
  HinderedFetching()
      : sample_(SampleModel::masked(octree::sphere(5))),
        points_(random_queries(400, -1.3, 1.3)),
        exact_(points_.size()) {
    const Model model = sample_.open();
    make_probe(model).closest_points(points_, exact_);
  }

  // Queries the next point.
  Status query_once(Probe& probe) {
    const std::size_t at = next_++ % points_.size();
    const ClosestPoint answer = probe.closest_point(points_[at], kUnhindered);
    EXPECT_LE(answer.lower, exact_[at].upper);
    EXPECT_GE(answer.upper, exact_[at].lower);
    degraded_ += answer.status == Status::kDegraded;
    return answer.status;
  }

  static void expect_same_memory(const Stats& before, const Stats& after) {
    EXPECT_EQ(after.frames, before.frames);
    EXPECT_EQ(after.arena_bytes, before.arena_bytes);
    EXPECT_EQ(after.table_bytes, before.table_bytes);
    EXPECT_LE(after.arena_bytes + after.table_bytes, after.budget_bytes);
    EXPECT_LE(after.pages_read - after.pages_evicted, after.frames);
  }

  SampleModel sample_;
  std::vector<Vec3> points_;
  std::vector<ClosestPoint> exact_;
  std::size_t next_ = 0;
  std::uint64_t degraded_ = 0;
};

// A page takes 100 ticks to read, so one of the fetch requests of 100 ticks is served.
TEST_F(HinderedFetching, SlowDiskLosesRequestsButDelaysNoAnswer) {
  SlowDisk disk;
  OpenOptions options;
  options.max_probes = 2;  // one of them for the worker
  options.memory_budget_bytes = sample_.min_budget(2) + 8 * 4096;
  const auto model = ModelState::open_model(sample_.path(), options, {disk, false});
  ASSERT_TRUE(model);
  const ModelState& state = ModelState::of(*model);
  const std::atomic<bool> never{false};
  FetchWorker worker = fetch_worker(state, &still_time, never);
  Probe probe = make_probe(*model);
  std::uint64_t reads = 0, queries = 0;
  disk.meanwhile = [&] {
    ++reads;
    for (int tick = 0; tick < 100; ++tick, ++queries) (void)query_once(probe);
  };
  const Stats before = model->stats();
  const std::uint64_t allocations = cache::allocation_count();
  std::uint64_t served = 0;
  for (int step = 0; step < 20; ++step, ++queries) {
    (void)query_once(probe);
    served += worker.work() == FetchWorker::Action::kServedRequest;
  }
  if (cache::allocations_are_counted()) {
    EXPECT_EQ(cache::allocation_count(), allocations);
  }
  const Stats after = model->stats();
  expect_same_memory(before, after);
  EXPECT_GT(reads, 50u);
  EXPECT_GT(after.pages_evicted, 0u);
  EXPECT_EQ(after.degraded_answers, degraded_);
  // Each degraded answer lacked pages. In each stretch of ticks every request but the last was
  // replaced by a later one.
  EXPECT_EQ(after.fetch_requests, degraded_);
  EXPECT_GT(after.fetch_requests, 40 * served);
}

// A frame that a reader may hold is not reused, however long the reader's section lasts.
TEST_F(HinderedFetching, ReaderThatNeverLeavesItsSectionCostsNoMemory) {
  const unsigned probes = 2;
  const Model model = sample_.open(sample_.min_budget(probes) + 8 * 4096, probes);
  Probe probe = make_probe(model);
  {
    auto stuck = ModelState::of(model).claim_reader();
    ASSERT_TRUE(stuck);
    stuck->enter();
    const Stats before = model.stats();
    // Repeats until the model's thread can evict no more, and for some time afterwards.
    std::uint64_t read = ~std::uint64_t{0};
    ASSERT_TRUE(eventually([&] {
      const std::uint64_t last = std::exchange(read, model.stats().pages_read);
      for (int i = 0; i < 400; ++i) (void)query_once(probe);
      return read == last && read >= model.stats().frames / 2;
    }));
    const Stats after = model.stats();
    expect_same_memory(before, after);
    // At most one frame in limbo for each fetcher.
    EXPECT_LE(after.pages_evicted - before.pages_evicted, probes + 2);
    EXPECT_GT(degraded_, 0u);
    EXPECT_GT(after.fetch_requests, after.fetch_requests_served);
    stuck->leave();
  }
  EXPECT_TRUE(eventually(
      [&] { return probe.closest_point(points_[0], kUnhindered).status == Status::kExact; }));
}

}  // namespace
}  // namespace planetree::query
