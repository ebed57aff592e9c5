// Models that fit into memory, whose pages fetch threads read ahead.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "planetree/planetree.h"
#include "query/serve/read_ahead.h"
#include "storage/file/page_file.h"
#include "tests/octree/support/sample_tree.h"
#include "tests/query/answer_bits.h"
#include "tests/query/eventually.h"
#include "tests/query/least_memory.h"
#include "tests/query/sample_model.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::query {
namespace {

constexpr QueryOptions kWithoutWaiting{.wait = Wait::kNever};

// A sphere with a hole, so that there are pages of all kinds.
class ReadingAhead : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<storage::TemporaryDirectory>();
    octree::Soup sphere = octree::sphere(5);
    sphere.erase(sphere.begin(), sphere.begin() + 300);
    build_soup(sphere, *folder_ / "open.ptree");
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static Model open(OpenOptions options) {
    options.read_ahead = true;
    auto model = Model::open(*folder_ / "open.ptree", options);
    EXPECT_TRUE(model);
    return *std::move(model);
  }
  static storage::FileHeader header() {
    auto file = storage::PageFile::open(*folder_ / "open.ptree");
    EXPECT_TRUE(file);
    return file->header();
  }
  // Pages that queries of the opened layers may read.
  static std::set<std::uint32_t> used_pages(std::uint32_t layers) {
    const storage::FileHeader file = header();
    const bool has_side = (layers & kSideLayer) != 0;
    std::set<std::uint32_t> pages;
    for (std::uint32_t page = 0; page < file.page_count; ++page) {
      const bool is_side = page >= file.first_cap_page();
      const bool is_field = page >= file.first_field_page() && page < file.first_mask_page();
      if (!is_side || (has_side && !is_field)) pages.insert(page);
    }
    return pages;
  }

  static inline std::unique_ptr<storage::TemporaryDirectory> folder_;
};

TEST_F(ReadingAhead, GivesOutEachPageThatQueriesReadOnce) {
  for (const std::uint32_t layers : {kDistanceLayer, kDistanceLayer | kFieldLayer, kAllLayers}) {
    ReadAhead pages(OpenLayers::of(header().model, layers), header());
    std::multiset<std::uint32_t> taken;
    std::mutex mutex;
    const auto take_all = [&] {
      for (;;) {
        const std::uint32_t page = pages.take();
        if (page == ReadAhead::kNoPage) break;
        const std::lock_guard lock(mutex);
        taken.insert(page);
      }
    };
    std::thread other(take_all);
    take_all();
    other.join();
    const std::set<std::uint32_t> used = used_pages(layers);
    EXPECT_TRUE(std::equal(taken.begin(), taken.end(), used.begin(), used.end())) << layers;
    EXPECT_EQ(pages.take(), ReadAhead::kNoPage);
  }
  EXPECT_LT(used_pages(kAllLayers).size(), header().page_count);
}

TEST_F(ReadingAhead, LeavesNoPageToMiss) {
  for (const std::uint32_t layers : {kDistanceLayer, kAllLayers})
    for (const unsigned threads : {1u, 3u}) {
      const Model model = open({.fetch_threads = threads, .layers = layers});
      const std::uint64_t used = used_pages(layers).size();
      ASSERT_TRUE(eventually([&] { return model.stats().pages_read == used; }));
      EXPECT_GT(model.stats().pages_read_ahead, used / 2);
      QueryOptions options = kWithoutWaiting;
      options.parts = layers == kAllLayers ? kAllParts : std::uint32_t{kDistance};
      Probe probe = make_probe(model);
      const Model waiting = open({.layers = layers});
      Probe other = make_probe(waiting);
      for (const Vec3& query : random_queries(500, -1.2, 1.2)) {
        const ClosestPoint answer = probe.closest_point(query, options);
        EXPECT_EQ(answer.status, Status::kExact);
        EXPECT_EQ(bits_of(answer), bits_of(other.closest_point(query, {.parts = options.parts})));
      }
      EXPECT_EQ(model.stats().pages_read, used);
      EXPECT_EQ(model.stats().pages_evicted, 0u);
    }
}

TEST_F(ReadingAhead, LeavesAloneWhatDoesNotFit) {
  OpenOptions options;
  options.max_probes = 1;
  options.memory_budget_bytes = least_memory_bytes(*folder_ / "open.ptree", options);
  const Model model = open(options);
  ASSERT_LT(model.stats().frames, used_pages(kAllLayers).size());
  Probe probe = make_probe(model);
  // A thread that serves these requests has nothing else to do in between.
  for (const Vec3& query : random_queries(20, -1.2, 1.2)) {
    (void)probe.closest_point(query, kWithoutWaiting);
    EXPECT_TRUE(eventually([&] {
      const Stats stats = model.stats();
      return stats.fetch_requests_served == stats.fetch_requests;
    }));
  }
  EXPECT_GT(model.stats().fetch_requests_served, 0u);
  EXPECT_EQ(model.stats().pages_read_ahead, 0u);
}

}  // namespace
}  // namespace planetree::query
