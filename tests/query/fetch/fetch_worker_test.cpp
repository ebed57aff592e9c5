// Real-time queries without threads or clocks: a seed decides what happens when.

#include "tests/query/fetch_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <random>
#include <thread>
#include <vector>

#include "planetree/probe.h"
#include "tests/query/answer_bits.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

constexpr QueryOptions kHastily{.wait = Wait::kNever};

// A simulated clock that advances by one millisecond each time it is read.
double simulated_seconds = 0;
FetchWorker::Seconds simulated_time() { return FetchWorker::Seconds(simulated_seconds += 0.001); }

/// A disk whose reads fail at random.
class UnreliableDisk final : public storage::FileCalls {
 public:
  ssize_t pread(int descriptor, void* out, std::size_t bytes, off_t offset) noexcept override {
    if (opened && random() % 200 == 0) {
      errno = EIO;
      return -1;
    }
    return FileCalls::pread(descriptor, out, bytes, offset);
  }
  std::mt19937 random;
  bool opened = false;
};

/// A disk with no bytes in the system's memory.
class ColdDisk final : public storage::FileCalls {
 public:
  ssize_t preadv2(int, const iovec*, int, off_t, int) noexcept override {
    errno = EAGAIN;
    return -1;
  }
};

class FetchWorkerSimulation : public testing::Test {
 protected:
  FetchWorkerSimulation() : sample_(SampleModel::masked(octree::sphere(5))) {}

  Model open(storage::FileCalls& calls, std::uint64_t more_bytes) {
    OpenOptions options;
    options.max_probes = 3;  // one of them for the worker
    options.memory_budget_bytes = sample_.min_budget(3) + more_bytes;
    auto model = ModelState::open_model(sample_.path(), options, {calls, false});
    EXPECT_TRUE(model);
    return *std::move(model);
  }

  std::vector<ClosestPoint> exact_answers(const std::vector<Vec3>& points) {
    const Model model = sample_.open();
    std::vector<ClosestPoint> answers(points.size());
    make_probe(model).closest_points(points, answers);
    return answers;
  }

  // Everything observable of a run: answers, and counts of the work done.
  std::vector<std::uint64_t> run(unsigned seed) {
    simulated_seconds = 0;
    UnreliableDisk disk;
    disk.random.seed(seed);
    const Model model = open(disk, 6 * 4096);
    disk.opened = true;
    const ModelState& state = ModelState::of(model);
    FetchWorker worker = fetch_worker(state, &simulated_time, never_);
    Probe probes[] = {make_probe(model), make_probe(model)};
    std::vector<Vec3> points = random_queries(40, -1.2, 1.2, seed);
    points.push_back({1e300, 0, 0});
    points.push_back({0, 1e30, -3});
    const std::vector<ClosestPoint> exact = exact_answers(points);
    std::mt19937 random(seed);
    std::vector<std::uint64_t> seen;
    for (int step = 0; step < 3000; ++step) {
      Probe& probe = probes[random() % 2];
      const std::size_t at = random() % points.size();
      const Vec3& point = points[at];
      switch (random() % 8) {
        case 0:
          probe.motion(point, {point.y, point.z, point.x});
          break;
        case 1:
        case 2:
        case 3:
          seen.push_back(static_cast<std::uint64_t>(worker.work()));
          break;
        default: {
          const ClosestPoint answer = probe.closest_point(point, kHastily);
          EXPECT_LE(answer.lower, exact[at].upper);
          EXPECT_GE(answer.upper, exact[at].lower);
          for (const std::uint64_t bits : bits_of(answer)) seen.push_back(bits);
        }
      }
    }
    const Stats stats = model.stats();
    for (const std::uint64_t count :
         {stats.page_hits, stats.page_misses, stats.pages_read, stats.pages_evicted,
          stats.quarantined_pages, stats.degraded_answers})
      seen.push_back(count);
    EXPECT_GT(stats.pages_evicted, 10u);
    return seen;
  }

  SampleModel sample_;
  const std::atomic<bool> never_{false};
};

TEST_F(FetchWorkerSimulation, SameSeedGivesTheSameRun) {
  for (const unsigned seed : {1u, 2u, 3u}) EXPECT_EQ(run(seed), run(seed)) << seed;
  EXPECT_NE(run(1), run(2));
}

TEST_F(FetchWorkerSimulation, OneRequestFetchesAllPagesItsAnswerNeeds) {
  const Model model = open(storage::FileCalls::real(), 64 << 20);
  const ModelState& state = ModelState::of(model);
  FetchWorker worker = fetch_worker(state, &simulated_time, never_);
  Probe probe = make_probe(model);
  EXPECT_EQ(worker.work(), FetchWorker::Action::kNone);
  for (const Vec3& point : random_queries(100, -1.2, 1.2)) {
    if (probe.closest_point(point, kHastily).status == Status::kExact) continue;
    EXPECT_EQ(worker.work(), FetchWorker::Action::kServedRequest);
    EXPECT_EQ(worker.work(), FetchWorker::Action::kNone);
    EXPECT_EQ(probe.closest_point(point, kHastily).status, Status::kExact);
  }
}

// A worker that kept its last answers would read no pages for a repeated query.
TEST_F(FetchWorkerSimulation, RequestIsServedAgainAfterItsPagesWereEvicted) {
  const Model model = open(storage::FileCalls::real(), 6 * 4096);
  const ModelState& state = ModelState::of(model);
  FetchWorker worker = fetch_worker(state, &simulated_time, never_);
  Probe other = make_probe(model);
  const std::vector<Vec3> elsewhere = random_queries(150, -1.2, 1.2, 9);
  const auto drive_out = [&] {
    for (const Vec3& point : elsewhere) (void)other.closest_point(point);
  };
  for (const Vec3& point : random_queries(10, -1.05, 1.05, 4)) {
    Probe probe = make_probe(model);
    for (int round = 0; round < 3; ++round) {
      drive_out();
      (void)probe.closest_point(point, kHastily);
      worker.work();
    }
    drive_out();
    Status status = Status::kDegraded;
    for (int round = 0; round < 4 && status != Status::kExact; ++round) {
      status = probe.closest_point(point, kHastily).status;
      worker.work();
    }
    EXPECT_EQ(status, Status::kExact);
  }
}

TEST_F(FetchWorkerSimulation, ServesRequestsWithALargeWorkLimit) {
  const Model model = open(storage::FileCalls::real(), 64 << 20);
  const ModelState& state = ModelState::of(model);
  FetchWorker worker = fetch_worker(state, &simulated_time, never_);
  Probe probe = make_probe(model);
  // From so far away nothing is pruned: every node is visited.
  const Vec3 far{1e30, 2e29, 0};
  const QueryOptions query_options{.parts = kDistance, .wait = Wait::kNever, .max_work = 1000000};
  EXPECT_EQ(probe.closest_point(far, query_options).status, Status::kDegraded);
  worker.work();
  EXPECT_EQ(probe.closest_point(far, query_options).status, Status::kExact);
}

TEST_F(FetchWorkerSimulation, StopFlagPreventsFurtherReads) {
  const Model model = open(storage::FileCalls::real(), 64 << 20);
  const ModelState& state = ModelState::of(model);
  const std::atomic<bool> stop{true};
  FetchWorker worker = fetch_worker(state, &simulated_time, stop);
  Probe probe = make_probe(model);
  (void)probe.closest_point({0, 1.1, 0.3}, kHastily);
  const std::uint64_t read = model.stats().pages_read;
  EXPECT_EQ(worker.work(), FetchWorker::Action::kServedRequest);
  EXPECT_EQ(model.stats().pages_read, read);
}

// However stale the triangle is, its normal is one of the mesh, and on a sphere those point
// outward.
TEST_F(FetchWorkerSimulation, NormalsOfDegradedAnswersPointOut) {
  const Model model = open(storage::FileCalls::real(), 0);
  const ModelState& state = ModelState::of(model);
  FetchWorker worker = fetch_worker(state, &simulated_time, never_);
  Probe probe = make_probe(model);
  std::size_t degraded = 0;
  for (const Vec3& point : random_queries(600, -1.2, 1.2, 6)) {
    const ClosestPoint answer = probe.closest_point(point, kHastily);
    if (degraded % 3 == 0) worker.work();
    if (answer.status != Status::kDegraded || answer.triangle == kNoTriangle) continue;
    ++degraded;
    const Vec3 &n = answer.normal, &p = answer.point;
    EXPECT_GT(n.x * p.x + n.y * p.y + n.z * p.z, 0.5);
  }
  EXPECT_GT(degraded, 50u);
}

TEST_F(FetchWorkerSimulation, RequestsComeBeforeMotionPrefetches) {
  const Model model = open(storage::FileCalls::real(), 64 << 20);
  const ModelState& state = ModelState::of(model);
  FetchWorker worker = fetch_worker(state, &simulated_time, never_);
  Probe moving = make_probe(model), waiting = make_probe(model);
  moving.motion({-1.2, 0, 0}, {1, 0, 0});
  EXPECT_EQ(worker.work(), FetchWorker::Action::kPrefetchedPosition);
  EXPECT_EQ(waiting.closest_point({0, 1.1, 0.3}, kHastily).status, Status::kDegraded);
  EXPECT_EQ(worker.work(), FetchWorker::Action::kServedRequest);
  for (int left = 3; left > 0; --left)
    EXPECT_EQ(worker.work(), FetchWorker::Action::kPrefetchedPosition);
  EXPECT_EQ(worker.work(), FetchWorker::Action::kNone);
}

// The pages of a few frames are those of the next query.
TEST_F(FetchWorkerSimulation, PrefetchesNothingWithFewFrames) {
  for (std::uint64_t more_frames = 0; more_frames < 6; ++more_frames) {
    const Model model = open(storage::FileCalls::real(), more_frames * 4096);
    FetchWorker worker = fetch_worker(ModelState::of(model), &simulated_time, never_);
    Probe probe = make_probe(model);
    probe.motion({-1.2, 0, 0}, {100, 0, 0});
    for (int left = 4; left > 0; --left)
      EXPECT_EQ(worker.work(), FetchWorker::Action::kPrefetchedPosition);
    EXPECT_EQ(worker.pages_prefetched() > 0, model.stats().frames >= 8) << model.stats().frames;
  }
}

// The worker knows from the motion whether a probe searches for sides.
TEST_F(FetchWorkerSimulation, MotionTellsThatAQueryHadToSearchForTheSide) {
  const Model model = open(storage::FileCalls::real(), 64 << 20);
  const ModelState& state = ModelState::of(model);
  Probe probe = make_probe(model);
  std::uint64_t seen = 0;
  const auto side_searches = [&](const Vec3& point) {
    probe.motion(point, {});
    Motion motion;
    for (FetchRequests& requests : state.serving().arena.fetch_requests)
      if (requests.motion.load_newer(seen, motion)) return motion.side_searches;
    return ~std::uint64_t{0};
  };
  EXPECT_EQ(side_searches({}), 0u);
  for (const Vec3& point : random_queries(300, -0.999, 0.999, 3)) (void)probe.closest_point(point);
  EXPECT_GT(side_searches({}), 0u);
}

// The only test here with a second thread, which only waits.
TEST_F(FetchWorkerSimulation, RequestsAndBlockingQueriesAlternate) {
  ColdDisk disk;
  const Model model = open(disk, 64 << 20);
  const ModelState& state = ModelState::of(model);
  FetchWorker worker = fetch_worker(state, &simulated_time, never_);
  Probe probe = make_probe(model);
  EXPECT_EQ(probe.closest_point({0, 1.1, 0.3}, kHastily).status, Status::kDegraded);
  const auto work_while_one_waits_for = [&](std::uint32_t page) {
    std::thread waiting([&] {
      cache::Reader reader = *state.claim_reader();
      reader.enter();
      EXPECT_NE(reader.fetch(page, {.reads_itself = false}).frame, nullptr);
      reader.leave();
    });
    state.cache().wait_for_wanted_page(std::chrono::minutes(1), never_);
    const FetchWorker::Action did = worker.work();
    waiting.join();
    return did;
  };
  EXPECT_EQ(work_while_one_waits_for(sample_.page_count() - 1),
            FetchWorker::Action::kReadAwaitedPage);
  // The awaited page is read as well, while the request is served.
  EXPECT_EQ(work_while_one_waits_for(sample_.page_count() - 2),
            FetchWorker::Action::kServedRequest);
  EXPECT_EQ(probe.closest_point({0, 1.1, 0.3}, kHastily).status, Status::kExact);
  EXPECT_EQ(worker.work(), FetchWorker::Action::kNone);
}

TEST_F(FetchWorkerSimulation, NoProbeStarvesAnother) {
  const Model model = open(storage::FileCalls::real(), 64 << 20);
  const ModelState& state = ModelState::of(model);
  FetchWorker worker = fetch_worker(state, &simulated_time, never_);
  Probe greedy = make_probe(model), modest = make_probe(model);
  EXPECT_EQ(modest.closest_point({0, 1.1, 0.3}, kHastily).status, Status::kDegraded);
  for (const Vec3& point : random_queries(3, -1.2, 1.2, 5)) {
    (void)greedy.closest_point(point, kHastily);
    worker.work();
  }
  EXPECT_EQ(modest.closest_point({0, 1.1, 0.3}, kHastily).status, Status::kExact);
}

}  // namespace
}  // namespace planetree::query
