#include "octree/geometry/work_limit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "octree/nearest/feature_normal.h"
#include "octree/nearest/nearest.h"
#include "octree/winding/crossings.h"
#include "octree/winding/winding_number.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

// Shapes of which much touches one answer.
struct Shape {
  std::string name;
  Soup soup;
};

Soup tetrahedra(std::size_t count) {
  const Vec3 o{0, 0, 0}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  Soup soup;
  for (std::size_t i = 0; i < count; ++i)
    soup.insert(soup.end(), {{o, y, x}, {o, x, z}, {x, y, z}, {o, z, y}});
  return soup;
}

Soup two_cones(std::size_t sides) {
  const auto rim = [&](std::size_t i) {
    const double angle =
        6.283185307179586 * static_cast<double>(i % sides) / static_cast<double>(sides);
    return Vec3{static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0};
  };
  Soup soup;
  for (std::size_t i = 0; i < sides; ++i) {
    soup.push_back({Vec3{0, 0, 1}, rim(i), rim(i + 1)});
    soup.push_back({Vec3{0, 0, -1}, rim(i + 1), rim(i)});
  }
  return soup;
}

Soup needles(std::size_t count) {
  Noise noise(3);
  Soup soup;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 from = noise.point(0, 1), to = noise.point(0, 1);
    soup.push_back({from, to, Vec3{to.x + 1e-14, to.y + 1e-14, to.z}});
  }
  return soup;
}

Soup segments(std::size_t count) {
  Noise noise(4);
  Soup soup;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 from = noise.point(0, 1);
    soup.push_back({from, from, noise.point(0, 1)});
  }
  return soup;
}

std::vector<Shape> slow_shapes() {
  return {{"closed tetrahedra in one place", tetrahedra(500)},
          {"two cones on one rim", two_cones(1000)},
          {"a triangle many times", repeated(2000)},
          {"a point many times", Soup(2000, {Vec3{1, 1, 1}, Vec3{1, 1, 1}, Vec3{1, 1, 1}})},
          {"a segment many times", Soup(2000, {Vec3{0, 0, 0}, Vec3{0, 0, 0}, Vec3{1, 0, 0}})},
          {"segments", segments(2000)},
          {"needles", needles(2000)}};
}

class WorkLimits : public testing::Test {
 protected:
  // Expects a search with each limit to keep it. search(tree, limit, reader, work) runs it.
  template <class Search>
  void expect_kept(const Search& search) {
    for (const Shape& shape : slow_shapes()) {
      const SampleTree sample = build_sample(shape.soup, 4096, 0, true);
      SamplePages pages(sample);
      const TreeInfo tree = tree_info(sample);
      const PageReader reader = pages.reader();
      for (const std::uint32_t max_work : {0u, 1u, 2u, 5u, 17u, 60u, 400u}) {
        TraversalStats work;
        search(tree, max_work, reader, work);
        EXPECT_LE(work.units, max_work) << shape.name;
        EXPECT_LE(work.nodes + work.blocks, work.units) << shape.name;
      }
    }
  }
};

const Point kQueries[] = {{0.1, 0.2, 0.3}, {0, 0, 0.25}, {0.3, 0.3, 0}, {2, -1, 0.5}};

TEST_F(WorkLimits, BoundTheNearestSearchAndKeepTheInterval) {
  expect_kept([](const TreeInfo& tree, std::uint32_t max_work, const PageReader& reader,
                 TraversalStats& work) {
    for (const Point& query : kQueries) {
      work = {};
      NearestLimits limits;
      const NearestAnswer exact = nearest(tree, query, limits, reader, work);
      work = {};
      limits.max_work = max_work;
      const NearestAnswer answer = nearest(tree, query, limits, reader, work);
      EXPECT_LE(answer.lower, exact.upper);
      EXPECT_GE(answer.upper, exact.lower);
      if (answer.status == Status::kExact) {
        EXPECT_EQ(answer.triangle, exact.triangle);
      } else {
        EXPECT_EQ(answer.status, Status::kDegraded);
      }
    }
  });
}

TEST_F(WorkLimits, BoundPseudonormals) {
  expect_kept([](const TreeInfo& tree, std::uint32_t max_work, const PageReader& reader,
                 TraversalStats& work) {
    const Point query(-0.2, -0.1, 1.5);
    const NearestAnswer exact = nearest(tree, query, {}, reader, work);
    FeatureNormal found;
    work = {};
    feature_normal(tree, query, exact, nullptr, WorkLimit::kNone, reader, work, found);
    const bool suffices = work.units <= max_work;
    work = {};
    feature_normal(tree, query, exact, nullptr, max_work, reader, work, found);
    EXPECT_EQ(found.complete, suffices);
  });
}

TEST_F(WorkLimits, BoundCrossings) {
  expect_kept([](const TreeInfo& tree, std::uint32_t max_work, const PageReader& reader,
                 TraversalStats& work) {
    // Passes through vertices and along faces.
    const PerturbedSegment segment{{0, 0, 0.25}, {0, 0, -2}};
    const Crossings exact = count_crossings(tree, segment, WorkLimit::kNone, reader, work);
    const bool suffices = work.units <= max_work;
    work = {};
    const Crossings found = count_crossings(tree, segment, max_work, reader, work);
    EXPECT_EQ(found.complete, suffices);
    if (found.complete) {
      EXPECT_EQ(found.difference, exact.difference);
    }
  });
}

TEST_F(WorkLimits, BoundSolidAngles) {
  expect_kept([](const TreeInfo& tree, std::uint32_t max_work, const PageReader& reader,
                 TraversalStats& work) {
    for (const Point& query : kQueries) {
      work = {};
      const WindingNumber exact = winding_number(tree, query, WorkLimit::kNone, reader, work);
      work = {};
      const WindingNumber found = winding_number(tree, query, max_work, reader, work);
      EXPECT_LE(std::fabs(found.value - exact.value), found.error + exact.error + 1e-9);
    }
  });
}

// Few of the triangles, which coincide, are evaluated for a query beside them.
void expect_few_evaluated(const Soup& coincident) {
  const SampleTree sample = build_sample(coincident);
  SamplePages pages(sample);
  const TreeInfo tree = tree_info(sample);
  TraversalStats work;
  const NearestAnswer answer = nearest(tree, Point(0.1, 0.2, 0.3), {}, pages.reader(), work);
  EXPECT_EQ(answer.triangle, 0u);
  EXPECT_LE(work.triangles, 128u);
  EXPECT_LE(work.units, 5 * tree.record_count);
}

TEST(CoincidentTriangles, AreEvaluatedOnceForEachFewBlocks) {
  for (const std::size_t count : {2'000u, 8'000u}) expect_few_evaluated(repeated(count));
}

TEST(CoincidentTriangles, OfAPointTakeNoWideNumbers) {
  expect_few_evaluated(Soup(4000, {Vec3{1, 1, 1}, Vec3{1, 1, 1}, Vec3{1, 1, 1}}));
}

}  // namespace
}  // namespace planetree::octree
