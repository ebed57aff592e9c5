// Queries that start from the coherence cache give the same answers for less work.

#include "octree/nearest/coherence_cache.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include <hwy/targets.h>

#include "octree/nearest/nearest.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

// All numbers of an answer, as bits.
std::vector<std::uint64_t> bits_of(const NearestAnswer& answer) {
  std::vector<std::uint64_t> bits{answer.triangle, static_cast<std::uint64_t>(answer.feature),
                                  static_cast<std::uint64_t>(answer.status)};
  const auto add = [&](double value) { bits.push_back(std::bit_cast<std::uint64_t>(value)); };
  for (const double value : {answer.distance, answer.lower, answer.upper}) add(value);
  for (const double value : answer.point) add(value);
  for (const double value : answer.barycentric) add(value);
  return bits;
}

// A path of short random steps, with a leap every `leap_every` queries.
std::vector<Point> wander(std::size_t count, double step, std::size_t leap_every) {
  Noise noise(3);
  std::vector<Point> path;
  Point at(0.45, 0.2, 0.1);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 by = noise.point(-step, step);
    at += Point(by.x, by.y, by.z);
    if (i % leap_every == leap_every - 1) {
      const Vec3 to = noise.point(-1.2, 1.2);
      at = Point(to.x, to.y, to.z);
    }
    path.push_back(at);
  }
  return path;
}

struct Path {
  explicit Path(const Soup& soup) : sample(build_sample(soup)), pages(sample) {}

  // Expects each answer along the path to have the same bits as without a coherence cache.
  void expect_same_answers(const std::vector<Point>& path, const NearestLimits& limits = {}) {
    CoherenceCache coherence_cache;
    for (const Point& query : path) {
      const NearestAnswer alone =
          nearest(tree_info(sample), query, limits, pages.reader(), work_alone);
      const NearestAnswer along =
          nearest(tree_info(sample), query, limits, pages.reader(), work_along, &coherence_cache);
      EXPECT_EQ(bits_of(along), bits_of(alone)) << query.transpose();
    }
  }

  SampleTree sample;
  SamplePages pages;
  TraversalStats work_alone, work_along;
};

// Queries that share one coherence cache.
struct Warm {
  explicit Warm(const Soup& soup) : sample(build_sample(soup)), pages(sample) {}

  NearestAnswer closest_point(const Point& query) {
    TraversalStats work;
    return nearest(tree_info(sample), query, {}, pages.reader(), work, &coherence_cache);
  }
  TraversalStats work(const Point& query, const NearestLimits& limits = {}) {
    TraversalStats work;
    nearest(tree_info(sample), query, limits, pages.reader(), work, &coherence_cache);
    return work;
  }

  SampleTree sample;
  SamplePages pages;
  CoherenceCache coherence_cache;
};

// Records whether page numbers outside of the file are requested.
struct WatchedPages {
  explicit WatchedPages(SamplePages& sample) : pages(sample), inner(sample.reader()) {}

  PageReader reader() {
    return {this, [](void* context, std::uint32_t number) noexcept {
              auto& self = *static_cast<WatchedPages*>(context);
              self.requested_unknown_page =
                  self.requested_unknown_page || number >= self.pages.size();
              return self.inner.page(self.inner.context, number);
            }};
  }

  SamplePages& pages;
  const PageReader inner;
  bool requested_unknown_page = false;  // a page outside of the file was requested
};

TEST(CoherenceCache, ChangesNoAnswer) {
  const std::pair<const char*, Soup> soups[] = {{"sphere", sphere(5)},
                                                {"a triangle many times", repeated(500)},
                                                {"a few too many to keep", repeated(40)},
                                                {"long triangles", scattered(400, 1.0)},
                                                {"small triangles", scattered(4000, 1e-2)},
                                                {"one triangle", repeated(1)}};
  for (const auto& [name, soup] : soups)
    for (const double step : {0.0, 1e-12, 1e-5, 1e-3, 0.02, 0.3}) {
      SCOPED_TRACE(std::string(name) + ", steps of " + std::to_string(step));
      Path(soup).expect_same_answers(wander(200, step, 50));
    }
}

// A fine height field so far from the origin that nearest points are off it by rounding, and two
// large triangles that float cannot rule out.
Soup far_height_field() {
  constexpr double kFar = 0x1p40, kAbove = 3 * kFar * 0x1p-52;
  constexpr int kSide = 64;
  const auto at = [&](int i, int j, double above) {
    const double x = i * 1.0 / kSide, y = j * 1.0 / kSide;
    return Vec3{kFar + x, kFar + y, kFar + x / 2 + y / 4 + above};
  };
  Soup soup;
  const auto add = [&](int i, int j, int step, double above) {
    const Vec3 a = at(i, j, above), b = at(i + step, j, above), c = at(i, j + step, above),
               d = at(i + step, j + step, above);
    soup.push_back({a, b, c});
    soup.push_back({b, d, c});
  };
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) add(i, j, 1, 0);
  add(0, 0, kSide, kAbove);
  return soup;
}

TEST(CoherenceCache, ChangesNoAnswerAtTheLastNearestPoint) {
  Path path(far_height_field());
  Noise noise(5);
  constexpr double kGrid = 0x1p40 * 0x1p-52;
  for (int round = 0; round < 100; ++round) {
    const Vec3 start = noise.point(0.2, 0.8);
    const double z = start.x / 2 + start.y / 4 - 40 * kGrid;
    const Point first = Point(start.x, start.y, z).array() + 0x1p40;
    const Point second = first + Point(0x1p-8, 0, 0);
    const Point results =
        nearest(tree_info(path.sample), second, {}, path.pages.reader(), path.work_alone).point;
    path.expect_same_answers({first, second, results});
  }
}

// First leaps just short enough to count as steps, then steps so short that a ball of few triangles
// is enough.
TEST(CoherenceCache, ShrinksTheBallWhenStepsGetShorter) {
  Warm warm(sphere(6));
  Point at(0.45, 0.15, 0.078);
  for (int i = 0; i < 4; ++i) warm.closest_point(at += Point(0, 0, 0.02));
  std::uint64_t visits = 0;
  for (int i = 0; i < 20; ++i) {
    const TraversalStats work = warm.work(at += Point(0, 1e-5, 0));
    visits = work.nodes + work.blocks;
  }
  EXPECT_EQ(visits, 0u);
}

TEST(CoherenceCache, StaysWithinMaxWork) {
  const NearestAnswer known = Warm(sphere(6)).closest_point(Point(0.35, 0.35, 0.1));
  for (const std::uint32_t most : {8u, 20u, 40u}) {
    Warm warm(sphere(6));
    NearestLimits limits;
    limits.max_work = most;
    limits.known = &known;
    for (int i = 0; i < 10; ++i) {
      const TraversalStats work = warm.work(Point(0.35, 0.355 + i * 1e-4, 0.1), limits);
      EXPECT_LE(work.nodes + work.blocks, most) << i;
    }
  }
}

// At this distance squares overflow in float and nothing is pruned. Old entries behind the end of a
// shortened list must not be taken for subtrees.
TEST(CoherenceCache, RequestsOnlyExistingPagesFarAway) {
  const Point far(0x1p61, 0x1p60, 0);
  for (const unsigned level : {3u, 4u, 5u, 6u}) {
    Warm warm(sphere(level));
    WatchedPages watched(warm.pages);
    TraversalStats alone;
    nearest(tree_info(warm.sample), far, {}, watched.reader(), alone);
    for (const Point& query : wander(60, 0.02, 7)) warm.closest_point(query);
    for (int i = 0; i < 4; ++i) {
      TraversalStats work;
      nearest(tree_info(warm.sample), far, {}, watched.reader(), work, &warm.coherence_cache);
      if (i < 2) continue;  // the first queries fill the cache
      EXPECT_LE(work.nodes + work.blocks, alone.nodes + alone.blocks) << level;
    }
    EXPECT_FALSE(watched.requested_unknown_page) << level;
  }
}

// With an allowed error and missing pages, the traversal has no bound for a long time.
TEST(CoherenceCache, RequestsOnlyExistingPagesWherePagesAreMissing) {
  for (const double step : {1e-3, 3e-3, 1e-2, 3e-2}) {
    Warm warm(sphere(5));
    WatchedPages watched(warm.pages);
    Point at(0.35, 0.355, 0.1);
    NearestAnswer known;
    for (int i = 0; i < 3; ++i) known = warm.closest_point(at += Point(0, step, 0));
    for (std::uint32_t page = 0; page < warm.pages.size(); ++page) warm.pages.withhold(page);
    NearestLimits limits;
    limits.known = &known;
    limits.max_error = 0.01;
    TraversalStats work;
    nearest(tree_info(warm.sample), at + Point(0, step, 0), limits, watched.reader(), work,
            &warm.coherence_cache);
    EXPECT_FALSE(watched.requested_unknown_page) << step;
  }
}

// Limited queries report intermediate results, which must not depend on the vector width.
TEST(CoherenceCache, GivesTheSameBitsOnEveryInstructionSet) {
  const Soup soup = scattered(20000, 0.03);
  NearestLimits limits;
  limits.max_work = 12;
  limits.max_error = 1e-4;
  const NearestAnswer known = Warm(soup).closest_point(Point(0.35, 0.35, 0.1));
  limits.known = &known;
  std::vector<std::vector<std::uint64_t>> results;
  for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
    hwy::SetSupportedTargetsForTest(left & -left);
    Warm warm(soup);
    std::vector<std::uint64_t> bits;
    for (const double step : {1e-4, 1e-3, 0.01})
      for (const Point& query : wander(300, step, 30)) {
        TraversalStats work;
        const NearestAnswer answer = nearest(tree_info(warm.sample), query, limits,
                                             warm.pages.reader(), work, &warm.coherence_cache);
        const auto more = bits_of(answer);
        bits.insert(bits.end(), more.begin(), more.end());
        bits.insert(bits.end(), {work.nodes, work.blocks, work.triangles, work.page_switches});
      }
    results.push_back(bits);
    hwy::SetSupportedTargetsForTest(0);
  }
  for (const auto& bits : results) EXPECT_EQ(bits == results[0], true);
}

TEST(CoherenceCache, ChangesNoAnswerWithinLimits) {
  NearestLimits near, rough, brief;
  near.max_distance = 0.05;
  rough.max_error = 0.01;
  brief.max_work = 7;
  for (const NearestLimits& limits : {near, rough, brief})
    Path(sphere(5)).expect_same_answers(wander(300, 1e-3, 100), limits);
}

TEST(CoherenceCache, ChangesNoAnswerWherePagesAreMissing) {
  Path path(sphere(5));
  ASSERT_GT(path.pages.size(), 8u);
  for (std::uint32_t page = 1; page < path.pages.size(); page += 3) path.pages.withhold(page);
  path.expect_same_answers(wander(300, 1e-3, 30));
}

TEST(CoherenceCache, HalvesNodeVisitsAlongAPath) {
  Path path(sphere(6));
  path.expect_same_answers(wander(500, 1e-4, 500));
  EXPECT_LT(path.work_along.nodes, path.work_alone.nodes / 2);
  EXPECT_LE(path.work_along.blocks, path.work_alone.blocks);
}

TEST(CoherenceCache, AccessesNoPageWhereTrianglesAreFew) {
  Warm warm(sphere(6));
  for (int i = 0; i < 12; ++i) {
    const TraversalStats work = warm.work(Point(0.35, 0.355 + i * 1e-6, 0.1));
    if (i < 2) continue;
    EXPECT_EQ(work.page_switches, 0u) << i;
  }
}

TEST(CoherenceCache, VisitsNoNodeWhereBlocksAreFew) {
  Warm warm(sphere(7));
  for (int i = 0; i < 8; ++i) {
    const TraversalStats work = warm.work(Point(0.35, 0.355 + i * 1.5e-3, 0.1));
    if (i < 2) continue;
    EXPECT_EQ(work.nodes, 0u) << i;
    EXPECT_GT(work.blocks, 0u) << i;
    EXPECT_FALSE(warm.coherence_cache.triangles().complete());
  }
}

TEST(CoherenceCache, StartsAtLowerNodesWhereBlocksAreMany) {
  Warm warm(sphere(7));
  std::uint64_t along = 0, alone = 0;
  for (int i = 0; i < 8; ++i) {
    const Point query(0.35, 0.355 + i * 3e-3, 0.1);
    const TraversalStats work = warm.work(query);
    if (i < 2) continue;
    EXPECT_FALSE(warm.coherence_cache.subtrees().are_blocks());
    along += work.nodes;
    TraversalStats cold;
    nearest(tree_info(warm.sample), query, {}, warm.pages.reader(), cold);
    alone += cold.nodes;
  }
  EXPECT_GT(along, 0u);
  EXPECT_LT(along, alone / 2);
}

TEST(CoherenceCache, AddsLittleWorkWithoutCoherence) {
  Path path(sphere(6));
  path.expect_same_answers(wander(500, 1e-4, 1));
  EXPECT_LT(path.work_along.nodes, path.work_alone.nodes + path.work_alone.nodes / 20);
}

TEST(CoherenceCache, IsEmptyBeforeTheFirstAnswer) {
  const CoherenceCache coherence_cache{};
  EXPECT_FALSE(coherence_cache.holds(coherence_cache.reach_of(Point(0, 0, 0))));
  EXPECT_EQ(coherence_cache.wanted_radius(Point(0, 0, 0), 1, 2), 0);
}

}  // namespace
}  // namespace planetree::octree
