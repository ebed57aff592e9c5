// Queries never allocate. They take no lock if all pages are resident, and real-time queries make
// no system call.

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <mutex>
#include <thread>

#include "octree/mask/cap_rim.h"
#include "planetree/probe.h"
#include "tests/cache/allocation_count.h"
#include "tests/query/call_trap.h"
#include "tests/query/lock_count.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

using cache::allocation_count;

class QueryPath : public testing::Test {
 protected:
  QueryPath() : sample_(octree::sphere(5)), queries_(random_queries(1500, -1.5, 1.5)) {
    answers_.resize(queries_.size());
  }
  void SetUp() override {
    if (!cache::allocations_are_counted() || !locks_are_counted())
      GTEST_SKIP() << "a sanitizer counts instead";
  }

  void query_everything(Probe& probe) {
    for (std::size_t i = 0; i < queries_.size(); ++i)
      answers_[i] = probe.closest_point(queries_[i]);
    probe.closest_points(queries_, answers_, {.max_error = 0.01});
    probe.closest_points(queries_, answers_, {.max_work = 7});
    probe.closest_point({1e300, 0, 0});
    probe.closest_point({0, 0, 1e30}, {.max_distance = 1});
  }

  SampleModel sample_;
  std::vector<Vec3> queries_;
  std::vector<ClosestPoint> answers_;
};

TEST_F(QueryPath, AllocationsAndLocksAreCounted) {
  const std::uint64_t allocations = allocation_count(), locks = lock_count();
  std::mutex mutex;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    const std::vector<int> memory(10);
  }
  EXPECT_GT(allocation_count(), allocations);
  EXPECT_GT(lock_count(), locks);
}

TEST_F(QueryPath, NeitherAllocatesNorLocksWhenAllIsResident) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  query_everything(probe);
  const std::uint64_t read = model.stats().pages_read;
  const std::uint64_t allocations = allocation_count(), locks = lock_count();
  query_everything(probe);
  EXPECT_EQ(allocation_count(), allocations);
  EXPECT_EQ(lock_count(), locks);
  EXPECT_EQ(model.stats().pages_read, read);
}

TEST_F(QueryPath, DoesNotAllocateWhileItFetches) {
  const Model model = sample_.open(sample_.min_budget());
  Probe probe = make_probe(model);
  const std::uint64_t allocations = allocation_count();
  query_everything(probe);
  EXPECT_EQ(allocation_count(), allocations);
  EXPECT_GT(model.stats().pages_evicted, 1000u);
}

// It is read when a model is opened, besides the model's budget.
TEST_F(QueryPath, TheRimOfCapsTakesOneAllocation) {
  const octree::SampleTree caps = octree::build_sample(octree::scattered(300, 0.3), 4096, 0, true);
  octree::SamplePages pages(caps);
  const octree::TreeInfo info = octree::tree_info(caps);
  octree::CapRim().read(info, pages.reader());  // decodes the pages
  octree::CapRim rim;
  const std::uint64_t allocations = allocation_count();
  rim.read(info, pages.reader());
  EXPECT_EQ(allocation_count(), allocations + 1);
  EXPECT_EQ(rim.caps(), 300u);
  EXPECT_EQ(rim.edges(), 900u);
}

// Tests that trap calls run on a thread of their own, because a trap cannot be removed.
class RealTimePath : public QueryPath {
 protected:
  static std::uint64_t page_faults() {
    rusage usage{};
    ::getrusage(RUSAGE_THREAD, &usage);
    return static_cast<std::uint64_t>(usage.ru_minflt + usage.ru_majflt);
  }

  void query_at_once(Probe& probe, int rounds) {
    for (int round = 0; round < rounds; ++round)
      for (const Vec3& query : queries_) {
        const ClosestPoint answer = probe.closest_point(query, {.wait = Wait::kNever});
        degraded_ += answer.status == Status::kDegraded;
        probe.contains(query, {.wait = Wait::kNever});
        probe.motion(query, {1, 0, 0});
      }
  }

  // Minimum over some rounds: the kernel itself may unmap pages to see whether they are used.
  std::uint64_t min_faults(Probe& probe) {
    std::uint64_t least = ~std::uint64_t{0};
    for (int round = 0; round < 5; ++round) {
      const std::uint64_t before = page_faults();
      query_at_once(probe, 1);
      least = std::min(least, page_faults() - before);
    }
    return least;
  }

  std::uint64_t degraded_ = 0;
};

TEST_F(RealTimePath, SystemCallsAreTrapped) {
  std::thread([] {
    if (!set_call_trap()) GTEST_SKIP() << "the system does not let itself be watched";
    const std::uint64_t before = trapped_calls();
    ::getppid();
    EXPECT_EQ(trapped_calls(), before + 1);
  }).join();
}

// The fetch thread reads and evicts pages meanwhile.
TEST_F(RealTimePath, NeitherAllocatesNorLocksNorCallsTheSystemNorFaults) {
  const Model model = sample_.open(sample_.min_budget() + 8 * 4096);
  Probe probe = make_probe(model);
  std::thread([&] {
    query_at_once(probe, 1);
    EXPECT_EQ(min_faults(probe), 0u);
    const bool trapping = set_call_trap();
    const std::uint64_t allocations = allocation_count(), locks = lock_count();
    const std::uint64_t calls = trapped_calls();
    for (int most = 5000; most > 0 && model.stats().pages_evicted < 300; --most)
      query_at_once(probe, 1);
    EXPECT_EQ(lock_count(), locks);
    EXPECT_EQ(allocation_count(), allocations);
    if (trapping) {
      EXPECT_EQ(trapped_calls(), calls);
    }
  }).join();
  EXPECT_GT(degraded_, 0u);
  EXPECT_GE(model.stats().pages_evicted, 300u);
}

}  // namespace
}  // namespace planetree::query
