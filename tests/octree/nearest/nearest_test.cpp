#include "octree/nearest/nearest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "octree/nearest/best_triangle.h"
#include "tests/octree/page/raw_page.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Point random_point(Noise& noise, double low = -1.5, double high = 1.5) {
  const Vec3 p = noise.point(low, high);
  return {p.x, p.y, p.z};
}

// A paged tree to query, with the expected results from a scan of all triangles.
struct SampleQueries {
  explicit SampleQueries(const Soup& soup, std::uint32_t page_bytes = 4096)
      : sample(build_sample(soup, page_bytes)), pages(sample), info(tree_info(sample)) {}

  NearestAnswer closest_point(const Point& query, const NearestLimits& limits = {}) {
    work = {};
    return nearest(info, query, limits, pages.reader(), work);
  }

  std::pair<double, std::uint64_t> least(const Point& query) const {
    std::pair<double, std::uint64_t> best{kInfinity, kNoTriangle};
    for (std::uint32_t i = 0; i < sample.mesh.size(); ++i)
      best = std::min(
          best, {triangle_value(query, sample.mesh.corners(i)).squared, sample.mesh.index(i)});
    return best;
  }

  // Expects [lower, upper] to overlap the interval of the true distance.
  void expect_interval_holds(const NearestAnswer& answer, const Point& query) const {
    const auto [squared, index] = least(query);
    const auto position = static_cast<std::uint32_t>(index);
    const double error = nearest_on_triangle(query, sample.mesh.corners(position)).value.error;
    EXPECT_LE(answer.lower, std::sqrt(squared) + error);
    EXPECT_GE(answer.upper, std::sqrt(squared) - error);
    EXPECT_LT(answer.lower, answer.upper);
  }

  SampleTree sample;
  SamplePages pages;
  TreeInfo info;
  TraversalStats work;
};

TEST(Nearest, ReturnsTheLeastValueThenIndex) {
  const std::pair<const char*, Soup> soups[] = {{"sphere", sphere(4)},
                                                {"a triangle many times", repeated(500)},
                                                {"long triangles", scattered(400, 1.0)},
                                                {"small triangles", scattered(400, 1e-3)}};
  for (const auto& [name, soup] : soups) {
    SCOPED_TRACE(name);
    SampleQueries queried(soup);
    Noise noise(1);
    for (int i = 0; i < 200; ++i) {
      const Point query = random_point(noise);
      const NearestAnswer answer = queried.closest_point(query);
      const auto [squared, index] = queried.least(query);
      EXPECT_EQ(answer.status, Status::kExact);
      EXPECT_EQ(std::bit_cast<std::uint64_t>(answer.distance),
                std::bit_cast<std::uint64_t>(std::sqrt(squared)));
      EXPECT_EQ(answer.triangle, index);
    }
  }
}

TEST(Nearest, BreaksTiesByIndex) {
  SampleQueries queried(sphere(4));
  // The centre of the sphere, its corners, and points above its edges.
  for (const Point& query : {Point(0, 0, 0), Point(1, 0, 0), Point(0, -3, 0), Point(0.5, 0.5, 0)})
    EXPECT_EQ(queried.closest_point(query).triangle, queried.least(query).second);
}

TEST(Nearest, GivesTheSameBitsForAnyPageSize) {
  SampleQueries small(scattered(2000, 0.1), 4096), large(scattered(2000, 0.1), 262144);
  ASSERT_GT(small.pages.size(), large.pages.size());
  Noise noise(2);
  for (int i = 0; i < 200; ++i) {
    const Point query = random_point(noise);
    const NearestAnswer one = small.closest_point(query), other = large.closest_point(query);
    EXPECT_EQ(one.distance, other.distance);
    EXPECT_EQ(one.triangle, other.triangle);
    EXPECT_EQ(one.point, other.point);
    EXPECT_EQ(one.lower, other.lower);
    EXPECT_EQ(one.upper, other.upper);
  }
}

TEST(Nearest, EvaluatesFewTriangles) {
  SampleQueries queried(sphere(6), 16384);
  queried.closest_point(Point(0.9, 0.5, 0.1));
  EXPECT_LT(queried.work.triangles, 64u);
  EXPECT_LT(queried.work.nodes + queried.work.blocks, 64u);
}

TEST(Nearest, IsExactAtAnyDistance) {
  SampleQueries queried(sphere(3));
  for (const double far : {1e6, 0x1p59, 0x1p61, 1e30, 0x1p200, kMaxQueryCoordinate}) {
    const NearestAnswer answer = queried.closest_point(Point(far, far / 3, -far / 7));
    EXPECT_EQ(answer.status, Status::kExact) << far;
    queried.expect_interval_holds(answer, Point(far, far / 3, -far / 7));
  }
}

TEST(Nearest, StopsAtMaxDistance) {
  SampleQueries queried(sphere(4));
  const double scale = queried.sample.mesh.upper().x();
  const Point query(3 * scale, 0, 0);
  NearestLimits limits;
  limits.max_distance = 1.9 * scale;
  NearestAnswer answer = queried.closest_point(query, limits);
  EXPECT_EQ(answer.status, Status::kBeyondMaxDistance);
  EXPECT_EQ(answer.lower, limits.max_distance);
  EXPECT_EQ(answer.upper, kInfinity);
  EXPECT_EQ(answer.triangle, kNoTriangle);
  limits.max_distance = 2 * scale;
  answer = queried.closest_point(query, limits);
  EXPECT_EQ(answer.status, Status::kExact);
  EXPECT_EQ(answer.distance, 2 * scale);
}

TEST(Nearest, StaysWithinMaxError) {
  SampleQueries queried(sphere(5));
  Noise noise(3);
  int within = 0;
  for (int i = 0; i < 400; ++i) {
    const Point query = random_point(noise);
    NearestLimits limits;
    limits.max_error = noise.uniform(0, 0.2);
    const NearestAnswer answer = queried.closest_point(query, limits);
    ASSERT_TRUE(answer.status == Status::kExact || answer.status == Status::kWithinError);
    EXPECT_LE(answer.upper - answer.lower, limits.max_error);
    queried.expect_interval_holds(answer, query);
    within += answer.status == Status::kWithinError;
  }
  EXPECT_GT(within, 100);
}

TEST(Nearest, SavesWorkWithMaxError) {
  SampleQueries queried(sphere(5));
  const Point query(0.01, 0.02, 0);  // near the centre, where all triangles are about equally far
  queried.closest_point(query);
  const std::uint64_t exact = queried.work.blocks;
  NearestLimits limits;
  limits.max_error = 0.1;
  queried.closest_point(query, limits);
  EXPECT_LT(queried.work.blocks * 2, exact);
}

// A triangle within max_distance may not be skipped by max_error: it is the only answer.
TEST(Nearest, AnswersWithinMaxDistanceDespiteMaxError) {
  SampleQueries queried(sphere(4));
  Noise noise(4);
  for (int i = 0; i < 300; ++i) {
    const Point query = random_point(noise, -2.5, 2.5);
    const double truth = std::sqrt(queried.least(query).first);
    NearestLimits limits;
    limits.max_distance = truth * noise.uniform(0.5, 2);
    limits.max_error = limits.max_distance * noise.uniform(0.1, 1.5);
    const NearestAnswer answer = queried.closest_point(query, limits);
    EXPECT_EQ(answer.status == Status::kBeyondMaxDistance, truth > limits.max_distance);
    queried.expect_interval_holds(answer, query);
  }
}

TEST(Nearest, IntervalHoldsAtAnyMaxWork) {
  SampleQueries queried(scattered(1500, 0.2));
  Noise noise(5);
  for (int i = 0; i < 40; ++i) {
    const Point query = random_point(noise);
    double width = kInfinity;
    for (const std::uint32_t nodes : {0u, 1u, 2u, 5u, 20u, 100u, 10000u}) {
      NearestLimits limits;
      limits.max_work = nodes;
      const NearestAnswer answer = queried.closest_point(query, limits);
      EXPECT_LE(queried.work.nodes + queried.work.blocks, nodes);
      queried.expect_interval_holds(answer, query);
      EXPECT_EQ(answer.status, nodes == 10000 ? Status::kExact : answer.status);
      if (nodes < 3) {
        EXPECT_EQ(answer.status, Status::kDegraded);
      }
      width = std::min(width, answer.upper - answer.lower);
    }
    EXPECT_LT(width, 1e-10);
  }
}

TEST(Nearest, AnswersFromTheSampleWithoutPages) {
  SampleQueries queried(sphere(4));
  queried.pages.withhold(0);
  const Point query(0.3, 0.2, 5);
  const NearestAnswer answer = queried.closest_point(query);
  EXPECT_EQ(answer.status, Status::kDegraded);
  EXPECT_EQ(answer.triangle, kNoTriangle);
  EXPECT_EQ(answer.point, queried.info.sample);
  EXPECT_EQ(answer.distance, answer.upper);
  queried.expect_interval_holds(answer, query);
}

// Only forged bounds exclude every triangle. Then nothing but the sample is known.
TEST(Nearest, AnswersFromTheSampleWhereBoundsExcludeEveryTriangle) {
  const SampleQueries queried(sphere(4));
  const Point query(0.3, 0.2, 5);
  const FloatQuery float_query = FloatQuery::from(query, queried.info);
  NearestLimits limits;
  const BestTriangle none(float_query, limits, queried.info.span(query));
  const NearestAnswer answer = finalize(queried.info, query, limits, none, float_query, {});
  EXPECT_EQ(answer.status, Status::kDegraded);
  EXPECT_EQ(answer.point, queried.info.sample);
  EXPECT_EQ(answer.lower, 0);
  queried.expect_interval_holds(answer, query);
  limits.max_distance = 2;
  EXPECT_EQ(finalize(queried.info, query, limits, none, float_query, {}).status,
            Status::kBeyondMaxDistance);
}

TEST(Nearest, IntervalHoldsWithMissingPages) {
  Noise noise(6);
  std::size_t exact = 0, degraded = 0;
  for (int round = 0; round < 8; ++round) {
    SampleQueries queried(sphere(4));
    for (std::uint32_t page = 1; page < queried.pages.size(); ++page)
      if (noise.bits() % 3 == 0) queried.pages.withhold(page);
    for (int i = 0; i < 50; ++i) {
      const Point query = random_point(noise);
      const NearestAnswer answer = queried.closest_point(query);
      queried.expect_interval_holds(answer, query);
      if (answer.status == Status::kExact) {
        EXPECT_EQ(answer.triangle, queried.least(query).second);
      }
      ++(answer.status == Status::kExact ? exact : degraded);
    }
  }
  EXPECT_GT(exact, 20u);
  EXPECT_GT(degraded, 20u);
}

// The decoder cannot check links to other pages. If a wrong one were followed, the sanitizers would
// report it.
TEST(Nearest, RefusesLinksThatMissARecord) {
  const SampleTree sample = build_sample(sphere(4), 4096);
  const SamplePages honest(sample);
  const std::uint32_t page = RawPage::of(honest.raw(0)).linked_pages[0];
  const std::uint32_t most = max_page_nodes(4096, sample.shape);
  ASSERT_LT(honest.frame(page).header().node_count, most);
  for (std::uint16_t number = 0; number < most; ++number) {
    SamplePages pages = honest;
    RawPage root = RawPage::of(honest.raw(0));
    // Two links to one page: the second link finds the page already accessed.
    root.linked_pages[1] = page;
    for (std::size_t i = 0; i < root.linked_pages.size(); ++i)
      if (root.linked_pages[i] == page) root.linked_nodes[i] = number;
    ASSERT_TRUE(decode_page(root.bytes(), page_info(sample, 0), pages.frame(0).bytes()));
    TraversalStats work;
    const NearestAnswer answer =
        nearest(tree_info(sample), Point(0, 0, 0), {}, pages.reader(), work);
    if (number >= honest.frame(page).header().node_count) {
      EXPECT_EQ(answer.status, Status::kDegraded) << number;
    }
    EXPECT_LT(answer.lower, answer.upper);
  }
}

// The header of a forged file may state that the tree is one block.
TEST(Nearest, RefusesABlockAsTheRootOfATreeWithNodes) {
  SampleTree sample = build_sample(sphere(4), 4096);
  for (const LinkTarget target : {LinkTarget::kSlot, LinkTarget::kNumber}) {
    sample.shape.links = target;
    SamplePages pages(sample);
    TreeInfo info = tree_info(sample);
    info.root_link = root_link_of(4096, target, 0, 0);
    TraversalStats work;
    EXPECT_EQ(nearest(info, Point(0, 0, 0), {}, pages.reader(), work).status, Status::kDegraded);
    EXPECT_EQ(work.blocks, 0u);
  }
}

TEST(Nearest, EndsOnForgedRecordCounts) {
  const SampleTree sample = build_sample(sphere(5), 4096);
  SamplePages pages(sample);
  TreeInfo info = tree_info(sample);
  info.record_count = 100;
  TraversalStats work;
  const NearestAnswer answer = nearest(info, Point(0, 0, 0), {}, pages.reader(), work);
  EXPECT_EQ(work.nodes + work.blocks, 100u);
  EXPECT_EQ(answer.status, Status::kDegraded);
}

}  // namespace
}  // namespace planetree::octree
