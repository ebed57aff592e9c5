// Queries that do not wait for pages: answered at once, refined by the fetch threads.

#include <gtest/gtest.h>

#include <thread>

#include "planetree/probe.h"
#include "tests/query/answer_bits.h"
#include "tests/query/eventually.h"
#include "tests/query/fetch_steps.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

constexpr QueryOptions kAtOnce{.wait = Wait::kNever};

class RealTime : public testing::Test {
 protected:
  RealTime()
      : sample_(SampleModel::masked(octree::sphere(5))), queries_(random_queries(300, -1.4, 1.4)) {}

  // Answers of blocking queries.
  std::vector<ClosestPoint> exact_answers() {
    const Model model = sample_.open();
    Probe probe = make_probe(model);
    std::vector<ClosestPoint> answers;
    for (const Vec3& query : queries_) answers.push_back(probe.closest_point(query));
    return answers;
  }

  // Repeats each of the first `count` queries until its answer is exact, then compares the bits.
  void expect_refined(Probe& probe, std::size_t count) {
    const std::vector<ClosestPoint> exact = exact_answers();
    for (std::size_t i = 0; i < count; ++i) {
      ClosestPoint answer;
      ASSERT_TRUE(eventually([&] {
        answer = probe.closest_point(queries_[i], kAtOnce);
        return answer.status == Status::kExact;
      })) << i;
      ASSERT_EQ(bits_of(answer), bits_of(exact[i])) << i;
    }
  }

  SampleModel sample_;
  std::vector<Vec3> queries_;
};

TEST_F(RealTime, AnswersAtOnceWithAnIntervalThatHolds) {
  const Model model = sample_.open(sample_.min_budget());
  Probe probe = make_probe(model);
  std::size_t degraded = 0;
  for (int round = 0; round < 2; ++round)
    for (const Vec3& query : queries_) {
      const ClosestPoint answer = probe.closest_point(query, kAtOnce);
      ASSERT_TRUE(sample_.interval_holds(answer, query));
      degraded += answer.status == Status::kDegraded;
    }
  EXPECT_GT(degraded, 0u);
  EXPECT_EQ(model.stats().degraded_answers, degraded);
  EXPECT_EQ(model.stats().degraded_without_misses, 0u);
}

TEST_F(RealTime, ReadsNothingItself) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  // The fetch thread has read nothing for this query yet.
  const ClosestPoint first = probe.closest_point(queries_[0], kAtOnce);
  EXPECT_EQ(first.status, Status::kDegraded);
  EXPECT_GT(model.stats().page_misses, 0u);
}

TEST_F(RealTime, IsRefinedToTheBitsOfABlockingQuery) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  expect_refined(probe, queries_.size());
  EXPECT_GT(model.stats().fetch_requests_served, 0u);
}

TEST_F(RealTime, IsRefinedWhereThePagesOfOneQueryFit) {
  const Model model = sample_.open(sample_.min_budget() + 24 * 4096);
  Probe probe = make_probe(model);
  expect_refined(probe, 30);
  EXPECT_GT(model.stats().pages_evicted, 0u);
}

TEST_F(RealTime, GivesSidesAtOnceOrUnknown) {
  const Model model = sample_.open(sample_.min_budget());
  Probe probe = make_probe(model);
  std::size_t known = 0, unknown = 0;
  for (const Vec3& query : queries_) {
    const Containment answer = probe.contains(query, kAtOnce);
    if (answer.status == Status::kDegraded) {
      EXPECT_EQ(answer.side, Side::kUnknown);
      ++unknown;
      continue;
    }
    ++known;
    const double radius = std::sqrt(query.x * query.x + query.y * query.y + query.z * query.z);
    // The faces of the sphere are flat.
    if (radius > 0.95 && radius <= 1) continue;
    EXPECT_EQ(answer.side, radius > 1 ? Side::kOutside : Side::kInside);
  }
  EXPECT_GT(known, 0u);
  EXPECT_GT(unknown, 0u);
}

TEST_F(RealTime, UsesTheLastNearestTriangleWherePagesAreMissing) {
  const Model model = sample_.open(sample_.min_budget());
  Probe probe = make_probe(model);
  const Vec3 here{1.1, 0.1, 0.2}, beside{1.0, 0.2, 0.35};
  ASSERT_TRUE(
      eventually([&] { return probe.closest_point(here, kAtOnce).status == Status::kExact; }));
  // The minimum budget holds few pages, so the pages of other queries evict these.
  for (const Vec3& query : queries_) (void)probe.closest_point(query, {.parts = kDistance});
  const ClosestPoint answer = probe.closest_point(beside, kAtOnce);
  EXPECT_NE(answer.triangle, kNoTriangle);
  EXPECT_TRUE(sample_.interval_holds(answer, beside));
  EXPECT_LT(answer.upper, 0.5);
}

TEST_F(RealTime, StopsAtMaxWork) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  for (const Vec3& query : queries_) (void)probe.closest_point(query);
  const std::uint64_t fetch_requests = model.stats().fetch_requests_served;
  const std::uint64_t work = probe.work_spent();
  const ClosestPoint answer =
      probe.closest_point({0.01, 0, 0}, {.parts = kDistance, .wait = Wait::kNever, .max_work = 3});
  EXPECT_EQ(answer.status, Status::kDegraded);
  EXPECT_EQ(probe.work_spent() - work, 3u);
  // All pages are resident, so there is nothing to request.
  EXPECT_EQ(model.stats().fetch_requests_served, fetch_requests);
}

// Number of pages that a fetch thread reads for this motion, if no page is resident but the first
// ones.
std::uint64_t pages_ahead(const SampleModel& sample, const Motion& motion) {
  OpenOptions options;
  options.max_probes = 2;
  const auto model = ModelState::open_model(sample.path(), options, {.starts_fetching = false});
  const std::atomic<bool> never{false};
  FetchWorker worker = fetch_worker(
      ModelState::of(*model), [] { return FetchWorker::Seconds(1); }, never);
  Probe probe = make_probe(*model);
  probe.motion(motion.position, motion.velocity);
  while (worker.work() != FetchWorker::Action::kNone) {
  }
  return worker.pages_prefetched();
}

TEST_F(RealTime, PrefetchesAlongAMotion) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  // At least 5 ms ahead, the probe will be at the other end.
  const Motion motion{{-1.2, 0, 0}, {2.4 / 0.005, 0, 0}};
  const std::uint64_t pages = pages_ahead(sample_, motion);
  EXPECT_GT(pages, 3u);
  probe.motion(motion.position, motion.velocity);
  ASSERT_TRUE(eventually([&] { return model.stats().pages_prefetched == pages; }));
  EXPECT_EQ(probe.closest_point({1.2, 0, 0}, kAtOnce).status, Status::kExact);
  EXPECT_EQ(model.stats().fetch_requests, 0u);
}

TEST_F(RealTime, ManyProbesAreServedByFewThreads) {
  const std::vector<ClosestPoint> exact = exact_answers();
  OpenOptions options;
  options.fetch_threads = 2;
  auto model = Model::open(sample_.path(), options);
  ASSERT_TRUE(model);
  std::vector<std::thread> threads;
  std::atomic<int> agreed{0};
  for (std::size_t t = 0; t < 5; ++t)
    threads.emplace_back([&, t] {
      Probe probe = make_probe(*model);
      const std::size_t i = 7 * t;
      agreed += eventually(
          [&] { return bits_of(probe.closest_point(queries_[i], kAtOnce)) == bits_of(exact[i]); });
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(agreed, 5);
}

TEST_F(RealTime, RefusesFetchThreadsOutOfRange) {
  OpenOptions options;
  for (const unsigned threads : {0u, OpenOptions::kMaxFetchThreads + 1}) {
    options.fetch_threads = threads;
    const auto model = Model::open(sample_.path(), options);
    ASSERT_FALSE(model);
    EXPECT_EQ(model.error().code, ErrorCode::kBadArgument);
  }
}

TEST_F(RealTime, LocksItsMemoryOrReportsFailure) {
  OpenOptions options;
  options.locking = Locking::kNever;
  const auto loose = Model::open(sample_.path(), options);
  ASSERT_TRUE(loose);
  EXPECT_EQ(loose->stats().locked_bytes, 0u);
  options.locking = Locking::kRequire;
  const auto model = Model::open(sample_.path(), options);
  if (!model) {
    EXPECT_EQ(model.error().code, ErrorCode::kNoMemory);
    return;
  }
  EXPECT_GE(model->stats().locked_bytes, model->stats().arena_bytes);
}

}  // namespace
}  // namespace planetree::query
