// Round trips to a model whose file was built in many chunks.

#include <cmath>

#include "query/model_state.h"
#include "tests/query/chunked_sphere.h"
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
};

// A page with a node or two comes with pages below it. If it came alone, 3 of the points would take
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

}  // namespace
}  // namespace planetree::query
