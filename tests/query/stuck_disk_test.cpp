// Disks that fail or stall while answers must be on time.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

#include "planetree/probe.h"
#include "query/model_state.h"
#include "tests/query/eventually.h"
#include "tests/query/sample_model.h"
#include "tests/storage/system/ring_calls.h"

namespace planetree::query {
namespace {

constexpr QueryOptions kNow{.wait = Wait::kNever};

/// A disk that can be made to stall or to fail. The flags also say whether the system has its bytes
/// in memory.
class FaultyDisk final : public storage::FileCalls {
 public:
  std::atomic<bool> stalls{false};
  std::atomic<bool> fails{false};
  std::atomic<bool> is_in_memory{false};
  std::atomic<int> waiting{0};
  std::atomic<int> reads{0};
  std::atomic<int> nonblocking_calls{0};  ///< non-blocking reads and read-ahead advice
  std::atomic<bool> delivers_after_wait{false};
  std::atomic<int> rings{0};
  std::atomic<int> waits{0};  ///< waits on rings
  std::atomic<std::int64_t> longest_wait_ns{0};

  int posix_fadvise(int, off_t, off_t, int) noexcept override {
    ++nonblocking_calls;
    return 0;
  }
  ssize_t preadv2(int descriptor, const iovec* parts, int part_count, off_t offset,
                  int flags) noexcept override {
    ++nonblocking_calls;
    if (is_in_memory || came_.exchange(false))
      return FileCalls::preadv2(descriptor, parts, part_count, offset, flags);
    errno = EAGAIN;
    return -1;
  }
  ssize_t pread(int descriptor, void* out, std::size_t bytes, off_t offset) noexcept override {
    ++waiting;
    ++reads;
    while (stalls) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    --waiting;
    if (fails) {
      errno = EIO;
      return -1;
    }
    return FileCalls::pread(descriptor, out, bytes, offset);
  }
  int io_uring_queue_init(unsigned entries, io_uring* ring, unsigned flags) noexcept override {
    ++rings;
    return FileCalls::io_uring_queue_init(entries, ring, flags);
  }
  int io_uring_submit_and_wait_timeout(io_uring* ring, io_uring_cqe** completion, unsigned count,
                                       __kernel_timespec* most) noexcept override {
    ++waits;
    longest_wait_ns =
        std::max<std::int64_t>(longest_wait_ns, most->tv_sec * 1'000'000'000 + most->tv_nsec);
    if (stalls) return -ETIME;
    came_ = delivers_after_wait.load();
    return FileCalls::io_uring_submit_and_wait_timeout(ring, completion, count, most);
  }

 private:
  std::atomic<bool> came_{false};
};

class StuckDisk : public testing::Test {
 protected:
  StuckDisk()
      : sample_(SampleModel::masked(octree::sphere(5))), queries_(random_queries(60, -1.4, 1.4)) {}

  Model open(std::uint64_t budget_bytes, unsigned wait_limit_ms = 60'000, unsigned max_probes = 4) {
    OpenOptions options;
    options.memory_budget_bytes = budget_bytes;
    options.max_probes = max_probes;
    options.wait_limit_ms = wait_limit_ms;
    auto model = ModelState::open_model(sample_.path(), options, {disk_});
    EXPECT_TRUE(model);
    return *std::move(model);
  }

  // Makes every query once; returns the number of degraded answers.
  std::size_t query_all(Probe& probe) {
    std::size_t degraded = 0;
    for (const Vec3& query : queries_) {
      const ClosestPoint answer = probe.closest_point(query, kNow);
      EXPECT_TRUE(sample_.interval_holds(answer, query));
      degraded += answer.status == Status::kDegraded;
    }
    return degraded;
  }

  SampleModel sample_;
  FaultyDisk disk_;
  std::vector<Vec3> queries_;
};

TEST_F(StuckDisk, RealTimeQueriesDoNotWait) {
  const Model model = open(std::uint64_t{64} << 20);
  Probe probe = make_probe(model);
  disk_.stalls = true;
  EXPECT_GT(query_all(probe), 0u);
  ASSERT_TRUE(eventually([&] { return disk_.waiting > 0; }));
  // A page is being read now, and will be until the disk continues.
  const std::uint64_t read = model.stats().pages_read;
  for (int round = 0; round < 3; ++round) EXPECT_GT(query_all(probe), 0u);
  EXPECT_EQ(model.stats().pages_read, read);
  EXPECT_EQ(disk_.waiting, 1);
  disk_.stalls = false;
  EXPECT_TRUE(
      eventually([&] { return probe.closest_point(queries_[0], kNow).status == Status::kExact; }));
  // Real-time queries do not even read without blocking. They leave that to the fetch threads,
  // which may block.
  EXPECT_EQ(disk_.nonblocking_calls, 0);
}

TEST_F(StuckDisk, BlockingQueriesWait) {
  const Model model = open(std::uint64_t{64} << 20);
  Probe patient = make_probe(model), hasty = make_probe(model);
  disk_.stalls = true;
  std::atomic<bool> answered{false};
  std::thread waiting([&] {
    EXPECT_EQ(patient.closest_point(queries_[0]).status, Status::kExact);
    answered = true;
  });
  ASSERT_TRUE(eventually([&] { return disk_.waiting > 0; }));
  EXPECT_GT(disk_.nonblocking_calls, 2);
  EXPECT_GT(query_all(hasty), 0u);
  EXPECT_FALSE(answered);
  disk_.stalls = false;
  waiting.join();
  EXPECT_TRUE(answered);
}

// No other thread reads pages that the disk gives in time.
TEST_F(StuckDisk, BlockingQueryReadsItsPagesItself) {
  if (!storage::RingCalls::are_available()) GTEST_SKIP() << "the system refuses io_uring";
  const Model model = open(std::uint64_t{64} << 20);
  Probe probe = make_probe(model);
  disk_.delivers_after_wait = true;
  const std::uint64_t read = model.stats().pages_read;
  const int reads = disk_.reads;
  for (const Vec3& query : queries_) EXPECT_EQ(probe.closest_point(query).status, Status::kExact);
  EXPECT_GT(model.stats().pages_read, read + 10);
  EXPECT_EQ(disk_.waits, static_cast<int>(model.stats().pages_read - read));
  EXPECT_EQ(disk_.reads, reads);
  EXPECT_EQ(disk_.rings, 1);
}

TEST_F(StuckDisk, QueriesPollIfTheyMayNotUseRings) {
  OpenOptions options;
  options.use_io_uring = false;
  auto model = ModelState::open_model(sample_.path(), options, {disk_});
  ASSERT_TRUE(model);
  Probe probe = make_probe(*model);
  for (const Vec3& query : queries_) EXPECT_EQ(probe.closest_point(query).status, Status::kExact);
  EXPECT_GT(model->stats().pages_read, 10u);
  EXPECT_EQ(disk_.rings, 0);
}

// File descriptors belong to the whole process, so a model uses few rings.
TEST_F(StuckDisk, NumberOfRingsIsLimited) {
  if (!storage::RingCalls::are_available()) GTEST_SKIP() << "the system refuses io_uring";
  constexpr unsigned kProbes = 20;
  const Model model = open(sample_.min_budget(kProbes), 60'000, kProbes);
  std::vector<Probe> probes;
  while (probes.size() < kProbes) probes.push_back(make_probe(model));
  for (std::size_t i = 0; i < queries_.size(); ++i)
    EXPECT_EQ(probes[i % kProbes].closest_point(queries_[i]).status, Status::kExact);
  EXPECT_EQ(disk_.rings, 16);
}

TEST_F(StuckDisk, EachWaitIsWithinTheLimit) {
  if (!storage::RingCalls::are_available()) GTEST_SKIP() << "the system refuses io_uring";
  for (const unsigned limit_ms : {3u, 60'000u}) {
    const Model model = open(std::uint64_t{64} << 20, limit_ms);
    Probe probe = make_probe(model);
    disk_.longest_wait_ns = 0;
    EXPECT_TRUE(sample_.interval_holds(probe.closest_point(queries_[0]), queries_[0]));
    EXPECT_GT(disk_.longest_wait_ns, 1'000'000);
    EXPECT_LE(disk_.longest_wait_ns, std::min(limit_ms, 20u) * std::int64_t{1'000'000});
  }
}

TEST_F(StuckDisk, BlockingQueryGivesUpAtTheLimit) {
  const Model model = open(std::uint64_t{64} << 20, 20);
  Probe probe = make_probe(model);
  disk_.stalls = true;
  for (std::uint64_t queried = 1; queried <= 3; ++queried) {
    const ClosestPoint answer = probe.closest_point(queries_[0]);
    EXPECT_EQ(answer.status, Status::kDegraded);
    EXPECT_TRUE(sample_.interval_holds(answer, queries_[0]));
    // A query waits for one page in vain, not for several in turn.
    EXPECT_EQ(model.stats().waits_given_up, queried);
  }
  EXPECT_EQ(model.stats().degraded_answers, 3u);
  const Vec3 near_surface{0.6, 0.8, 0.001};  // not in a cell of one colour
  EXPECT_EQ(probe.contains(near_surface).status, Status::kDegraded);
  disk_.stalls = false;
  ASSERT_TRUE(eventually([&] { return disk_.waiting == 0; }));
  EXPECT_EQ(model.stats().quarantined_pages, 0u);
  EXPECT_TRUE(
      eventually([&] { return probe.closest_point(queries_[0]).status == Status::kExact; }));
}

// Queries read other pages meanwhile; at most one page is stuck.
TEST_F(StuckDisk, PagesInTheSystemsMemoryAreReadMeanwhile) {
  const Model model = open(std::uint64_t{64} << 20, 20);
  Probe stuck = make_probe(model), lucky = make_probe(model);
  disk_.stalls = true;
  EXPECT_EQ(stuck.closest_point(queries_[0]).status, Status::kDegraded);
  ASSERT_EQ(disk_.waiting, 1);
  disk_.is_in_memory = true;
  std::size_t exact = 0;
  for (const Vec3& query : queries_)
    exact += lucky.closest_point(query, {.parts = kDistance}).status == Status::kExact;
  EXPECT_GT(exact, 0u);
  EXPECT_EQ(disk_.waiting, 1);
  disk_.stalls = false;
}

TEST_F(StuckDisk, PageThatSeveralQueriesWaitForIsReadOnce) {
  const Model model = open(std::uint64_t{64} << 20);
  const std::uint64_t misses = model.stats().page_misses;
  // Opening has read the directory too.
  const std::uint64_t others = static_cast<std::uint64_t>(disk_.reads) - model.stats().pages_read;
  disk_.stalls = true;
  std::vector<std::thread> threads;
  std::atomic<int> exact{0};
  for (int i = 0; i < 3; ++i)
    threads.emplace_back([&] {
      Probe probe = make_probe(model);
      exact += probe.closest_point(queries_[0]).status == Status::kExact;
    });
  const bool all_wait = eventually([&] { return model.stats().page_misses == misses + 3; });
  disk_.stalls = false;
  for (std::thread& thread : threads) thread.join();
  EXPECT_TRUE(all_wait);
  EXPECT_EQ(exact, 3);
  EXPECT_EQ(model.stats().pages_read + others, static_cast<std::uint64_t>(disk_.reads));
}

TEST_F(StuckDisk, UnreadablePagesDegradeAnswersForGood) {
  const Model model = open(sample_.min_budget(4));
  Probe probe = make_probe(model);
  disk_.fails = true;
  ASSERT_TRUE(eventually([&] {
    query_all(probe);
    return model.stats().quarantined_pages > 0;
  }));
  disk_.fails = false;
  EXPECT_GT(query_all(probe), 0u);
}

// The boxes of a missing page's content are known.
TEST_F(StuckDisk, MissingPageBoundsTheDistanceFromAbove) {
  const Model model = open(std::uint64_t{64} << 20);
  Probe probe = make_probe(model);
  disk_.stalls = true;
  // The sphere's sample vertex is on the opposite side.
  const Vec3 beside{-1.5, 0, 0};
  const ClosestPoint answer =
      probe.closest_point(beside, {.parts = kDistance, .wait = Wait::kNever});
  EXPECT_EQ(answer.status, Status::kDegraded);
  EXPECT_EQ(answer.triangle, kNoTriangle);
  EXPECT_TRUE(sample_.interval_holds(answer, beside));
  EXPECT_LT(answer.upper, 2.2);
  EXPECT_EQ(answer.distance, answer.upper);
  disk_.stalls = false;
}

}  // namespace
}  // namespace planetree::query
