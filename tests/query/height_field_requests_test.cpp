// Where faces decide sides, real-time queries may still need the mask.

#include <gtest/gtest.h>

#include <atomic>

#include "planetree/probe.h"
#include "tests/octree/builder/build_fixture.h"
#include "tests/octree/builder/silent_progress.h"
#include "tests/query/fetch_steps.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

class HeightFieldRequests : public octree::SmallChunks {
 protected:
  HeightFieldRequests() {
    write(octree::sphere(5));
    octree::SilentProgress silent;
    octree::BuildOptions options;
    options.page_bytes = 4096;
    if (!octree::build_tree(mesh_, output_, options, silent)) std::abort();
  }
  // Opens with little more memory than opening takes, so that pages are evicted.
  Model open() const {
    OpenOptions options;
    options.max_probes = 3;
    const auto opened = [&] {
      return ModelState::open_model(output_, options, {storage::FileCalls::real(), false});
    };
    for (options.memory_budget_bytes = 1 << 16; !opened(); options.memory_budget_bytes += 1 << 16)
      if (options.memory_budget_bytes > 1 << 24) std::abort();
    options.memory_budget_bytes += 1 << 16;
    return *opened();
  }

  const std::atomic<bool> never_{false};
};

// A fetch thread keeps no earlier answers. It may find a side without the mask where the requesting
// probe cannot.
TEST_F(HeightFieldRequests, FetchTheMaskWhereFacesDecideTheSide) {
  const Model model = open();
  const ModelState& state = ModelState::of(model);
  FetchWorker worker = fetch_worker(state, &still_time, never_);
  constexpr QueryOptions kHasty{.wait = Wait::kNever};
  Probe probe = make_probe(model);
  unsigned wished = 0;
  for (const Vec3& point : random_queries(300, -1, 1)) {
    // Near the surface, where no cell of the side grid has one colour.
    const double length = std::sqrt(point.x * point.x + point.y * point.y + point.z * point.z);
    const double share = 0.999 / length;
    const Vec3 near{point.x * share, point.y * share, point.z * share};
    if (probe.closest_point(near, kHasty).status == Status::kExact) continue;
    ++wished;
    while (worker.work() != FetchWorker::Action::kNone) {
    }
    EXPECT_EQ(probe.closest_point(near, kHasty).status, Status::kExact);
    EXPECT_EQ(probe.contains(near, kHasty).status, Status::kExact);
  }
  EXPECT_GT(wished, 20u);
}

// A prefetch reads pages of the mask only if the moving probe searches for sides.
TEST_F(HeightFieldRequests, PrefetchesLeaveTheMaskOutWhereFacesDecideTheSide) {
  const auto pages_read = [this](FetchReason reason) {
    const Model model = open();
    const ModelState& state = ModelState::of(model);
    QueryingFetchProbe probe(state.serving(), *state.claim_reader());
    const std::uint64_t before = model.stats().pages_read;
    QueryOptions options;
    options.max_work = QueryOptions::kRealTimeWork;
    for (const Vec3& point : random_queries(100, -1, 1)) {
      const double share =
          0.999 / std::sqrt(point.x * point.x + point.y * point.y + point.z * point.z);
      probe.fetch_pages({point.x * share, point.y * share, point.z * share}, options, reason, {},
                        never_);
    }
    return model.stats().pages_read - before;
  };
  const std::uint64_t tree_pages = pages_read(FetchReason::kMotion);
  EXPECT_GT(tree_pages, 10u);
  EXPECT_LT(tree_pages, pages_read(FetchReason::kMotionOfSides));
  EXPECT_EQ(pages_read(FetchReason::kMotionOfSides), pages_read(FetchReason::kMissed));
}

}  // namespace
}  // namespace planetree::query
