// Round trips to a model whose file was built in many chunks.

#include <atomic>
#include <cmath>

#include "query/model_state.h"
#include "tests/query/chunked_sphere.h"
#include "tests/query/fetch_steps.h"
#include "tests/query/sample_model.h"
#include "tests/storage/http/range_server.h"

namespace planetree::query {
namespace {

// Most of its upper pages, among them those with a node or two, are behind what opening reads.
class RemoteChunks : public ChunkedSphere {
 protected:
  RemoteChunks() : ChunkedSphere(8, 300), server_(storage::text_of(output_.string())) {}

  // Returns the round trips of a query that is the first one of its model.
  std::uint64_t rounds_of_first_query(const Vec3& point) {
    const auto model = ModelState::open_model(server_.url(), {}, {});
    if (!model) std::abort();
    Probe probe = make_probe(*model);
    const std::uint64_t opened = model->stats().http_rounds;
    EXPECT_EQ(probe.closest_point(point).status, Status::kExact);
    return model->stats().http_rounds - opened;
  }

  storage::RangeServer server_;
  const std::atomic<bool> never_{false};
};

// A page with a node or two comes with pages below it. If it came alone, several points would take
// more than one round trip.
TEST_F(RemoteChunks, FirstQueriesWaitForNoPageWithFewNodes) {
  std::size_t with_more_rounds = 0;
  for (const Vec3& point : random_queries(20, -1, 1)) {
    const double length = std::hypot(point.x, point.y, point.z);
    const std::uint64_t rounds =
        rounds_of_first_query({point.x / length, point.y / length, point.z / length});
    EXPECT_LE(rounds, 2u);
    with_more_rounds += rounds > 1;
  }
  EXPECT_LE(with_more_rounds, 1u);
}

// The positions that the probe reaches within the shortest horizon, by quarters.
TEST_F(RemoteChunks, AMovingProbeGetsThePagesAheadWithThoseThatItLacks) {
  constexpr double kSpeed = 100;
  const auto model = ModelState::open_model(server_.url(), {}, {.starts_fetching = false});
  ASSERT_TRUE(model);
  FetchWorker worker = fetch_worker(ModelState::of(*model), &still_time, never_);
  Probe probe = make_probe(*model);
  const Vec3 start{0.9, 0.1, 0.3};
  const auto status_at = [&](double seconds) {
    const Vec3 position{start.x, start.y + kSpeed * seconds, start.z};
    return probe.closest_point(position, {.parts = kDistance, .wait = Wait::kNever}).status;
  };
  probe.motion(start, {0, kSpeed, 0});
  ASSERT_EQ(status_at(0), Status::kDegraded);
  ASSERT_EQ(worker.work(), FetchWorker::Action::kServedRequest);
  const double quarter = MotionPrefetch::kMinHorizon.count() / MotionPrefetch::kPositions;
  for (unsigned i = 0; i <= MotionPrefetch::kPositions; ++i)
    EXPECT_EQ(status_at(quarter * i), Status::kExact) << i;
}

}  // namespace
}  // namespace planetree::query
