// Queries that do not wait never touch the network: they call no system, lock and allocate nothing,
// while fetch threads get pages from a server.

#include <thread>

#include "tests/cache/allocation_count.h"
#include "tests/query/call_trap.h"
#include "tests/query/lock_count.h"
#include "tests/query/remote/remote_fixture.h"

namespace planetree::query {
namespace {

class RemotePath : public RemoteModel {
 protected:
  RemotePath() : RemoteModel(7) {}
  void SetUp() override {
    if (!cache::allocations_are_counted() || !locks_are_counted())
      GTEST_SKIP() << "a sanitizer counts instead";
  }
};

TEST_F(RemotePath, NeitherAllocatesNorLocksNorCallsTheSystem) {
  options_.memory_budget_bytes = *ModelState::min_budget_bytes(server_.url(), options_) + 8 * 4096;
  const Model model = open();
  Probe probe = make_probe(model);
  std::size_t degraded = 0;
  std::thread([&] {
    const auto query_at_once = [&] {
      for (const Vec3& query : queries_) {
        degraded += probe.closest_point(query, {.wait = Wait::kNever}).status == Status::kDegraded;
        probe.contains(query, {.wait = Wait::kNever});
        probe.motion(query, {1, 0, 0});
      }
    };
    query_at_once();
    const bool is_trapping = set_call_trap();
    const std::uint64_t allocations = cache::thread_allocation_count(), locks = lock_count();
    const std::uint64_t calls = trapped_calls();
    const unsigned requests = server_.requests();
    for (int most = 5000;
         most > 0 && (model.stats().pages_evicted < 300 || server_.requests() < requests + 3);
         --most)
      query_at_once();
    EXPECT_EQ(lock_count(), locks);
    EXPECT_EQ(cache::thread_allocation_count(), allocations);
    if (is_trapping) {
      EXPECT_EQ(trapped_calls(), calls);
    }
  }).join();
  EXPECT_GT(degraded, 0u);
  EXPECT_GE(model.stats().pages_evicted, 300u);
}

}  // namespace
}  // namespace planetree::query
