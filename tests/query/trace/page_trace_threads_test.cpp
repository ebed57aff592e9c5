// Page traces of several threads, drained while they run.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <set>
#include <thread>
#include <vector>

#include "planetree/probe.h"
#include "query/model_state.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

using Event = PageAccess::Event;

class PageTraceThreads : public testing::Test {
 protected:
  static constexpr unsigned kThreads = 3;

  // A model with few frames, so that pages are evicted all the time.
  Model open() const {
    OpenOptions options;
    options.max_probes = kThreads;
    options.fetch_threads = 2;
    options.page_trace_capacity = 1 << 18;
    options.memory_budget_bytes = *ModelState::min_budget_bytes(sample_.path(), options) + 4 * 4096;
    auto model = Model::open(sample_.path(), options);
    EXPECT_TRUE(model) << (model ? "" : model.error().text);
    return *std::move(model);
  }

  // Two real-time probes and one whose queries wait.
  static void query(const Model& model, unsigned thread) {
    Probe probe = make_probe(model);
    const QueryOptions options{.wait = thread == 0 ? Wait::kForPages : Wait::kNever};
    const std::vector<Vec3> points = random_queries(thread == 0 ? 300 : 6000, -1.2, 1.2, thread);
    for (std::size_t i = 1; i < points.size(); ++i) {
      const Vec3& point = points[i];
      if (i % 7 == 0) probe.motion(point, {point.y, point.z, point.x});
      (void)probe.closest_point(point, options);
      if (i % 50 == 0) std::this_thread::yield();
    }
  }

  // Everything that happened until the threads and the model's fetch threads have ended.
  static std::vector<PageAccess> trace_of(const Model& model) {
    std::vector<PageAccess> all;
    const auto drain = [&] {
      std::vector<PageAccess> drained(512);
      for (std::size_t count = drained.size(); count == drained.size();) {
        count = model.drain_page_trace(drained);
        all.insert(all.end(), drained.begin(),
                   drained.begin() + static_cast<std::ptrdiff_t>(count));
      }
    };
    std::atomic<unsigned> running{kThreads};
    std::vector<std::thread> threads;
    for (unsigned thread = 0; thread < kThreads; ++thread)
      threads.emplace_back([&model, &running, thread] {
        query(model, thread);
        --running;
      });
    while (running.load() > 0) drain();
    for (std::thread& thread : threads) thread.join();
    drain();
    return all;
  }

  const SampleModel sample_ = SampleModel::masked(octree::sphere(5));
};

TEST_F(PageTraceThreads, RecordsOfEachProbeAreInOrder) {
  const Model model = open();
  std::map<std::uint32_t, PageAccess> last;  // by probe
  for (const PageAccess& access : trace_of(model)) {
    const auto [before, is_first] = last.emplace(access.probe, access);
    EXPECT_GE(access.time_ns, before->second.time_ns);
    // A motion has the number of the next query.
    const bool was_motion = before->second.event == Event::kMotion;
    EXPECT_TRUE(access.query_kind != before->second.query_kind ||
                access.query + was_motion >= before->second.query);
    before->second = access;
    EXPECT_LT(access.page, model.info().pages);
    EXPECT_LT(access.probe, kThreads + 2);
  }
  EXPECT_GE(last.size(), kThreads);
}

// Each page read or evicted has a time of its own, so that what is in memory is known at any time,
// also where two threads read pages at once.
TEST_F(PageTraceThreads, PagesComeAndGoInTurn) {
  const Model model = open();
  std::vector<PageAccess> changes = trace_of(model);
  const Stats stats = model.stats();
  std::erase_if(changes, [](const PageAccess& access) {
    return access.event != Event::kInstalled && access.event != Event::kEvicted &&
           access.event != Event::kEvictedUnused;
  });
  std::ranges::sort(changes, {}, &PageAccess::time_ns);
  std::set<std::uint32_t> resident;
  std::uint64_t time = 0, evicted = 0;
  for (const PageAccess& access : changes) {
    EXPECT_GT(access.time_ns, time);
    time = access.time_ns;
    if (access.event == Event::kInstalled) {
      EXPECT_TRUE(resident.insert(access.page).second);
      EXPECT_LE(resident.size(), stats.frames);
    } else {
      EXPECT_EQ(resident.erase(access.page), 1u);
      ++evicted;
    }
  }
  EXPECT_GT(evicted, 100u);
  EXPECT_EQ(stats.page_trace_dropped, 0u);
}

}  // namespace
}  // namespace planetree::query
