#include "octree/builder/mesh/stream/polygon_triangulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/octree/support/polygon_shapes.h"

namespace planetree::octree {
namespace {

/// The triangles of the last polygon.
std::vector<CornerTriple> triangles_of(const PolygonTriangulator& split, std::uint32_t corners) {
  std::vector<CornerTriple> fan;
  for (std::uint32_t k = 2; k < corners; ++k) fan.push_back({0, k - 1, k});
  const auto triangles = split.triangles();
  return split.is_fan() ? fan : std::vector(triangles.begin(), triangles.end());
}

/// Number of triangles that contain the middle of the unit square at `cell`, with signs.
std::int64_t cover(const FlatPolygon& polygon, const std::vector<CornerTriple>& triangles,
                   const FlatPoint& cell) {
  std::int64_t count = 0;
  const auto doubled = [&](std::uint32_t k) {
    return FlatPoint{3 * polygon[k][0] - cell[0], 3 * polygon[k][1] - cell[1]};
  };
  for (const auto& [i, j, k] : triangles) {
    const FlatPoint a = doubled(i), b = doubled(j), c = doubled(k), o = {0, 0};
    const bool left = area_of(a, b, o) > 0 && area_of(b, c, o) > 0 && area_of(c, a, o) > 0;
    const bool right = area_of(a, b, o) < 0 && area_of(b, c, o) < 0 && area_of(c, a, o) < 0;
    count += left ? 1 : right ? -1 : 0;
  }
  return count;
}

/// Winding number of a polygon about cell / 3, which lies on none of its edges.
std::int64_t winding(const FlatPolygon& polygon, const FlatPoint& cell) {
  std::int64_t count = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const FlatPoint &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    const FlatPoint a = {3 * p[0] - cell[0], 3 * p[1] - cell[1]};
    const FlatPoint b = {3 * q[0] - cell[0], 3 * q[1] - cell[1]};
    if ((a[1] > 0) == (b[1] > 0)) continue;
    const std::int64_t side = area_of(a, b, {0, 0});
    if (side != 0 && (side > 0) == (b[1] > 0)) count += b[1] > 0 ? 1 : -1;
  }
  return count;
}

/// Whether an edge goes through cell / 3.
bool is_on_edge(const FlatPolygon& polygon, const std::vector<CornerTriple>& triangles,
                const FlatPoint& cell) {
  const auto at = [&](std::uint32_t k) {
    return FlatPoint{3 * polygon[k][0] - cell[0], 3 * polygon[k][1] - cell[1]};
  };
  return std::ranges::any_of(triangles, [&](const CornerTriple& t) {
    return area_of(at(t[0]), at(t[1]), {0, 0}) == 0 || area_of(at(t[1]), at(t[2]), {0, 0}) == 0 ||
           area_of(at(t[2]), at(t[0]), {0, 0}) == 0;
  });
}

/// Checks the triangles of a simple polygon that runs counterclockwise.
void expect_partition(const FlatPolygon& polygon, const std::vector<CornerTriple>& triangles) {
  ASSERT_EQ(triangles.size(), polygon.size() - 2);
  std::vector<bool> used(polygon.size());
  std::int64_t sum = 0;
  for (const CornerTriple& t : triangles) {
    for (const std::uint32_t k : t) used.at(k) = true;
    const std::int64_t area = area_of(polygon[t[0]], polygon[t[1]], polygon[t[2]]);
    ASSERT_GE(area, 0) << t[0] << " " << t[1] << " " << t[2];
    sum += area;
  }
  EXPECT_EQ(sum, area_of(polygon));
  EXPECT_EQ(std::ranges::count(used, false), 0);
}

/// Compares with winding numbers at up to `points` points.
void expect_cover(std::mt19937_64& random, const FlatPolygon& polygon,
                  const std::vector<CornerTriple>& triangles, int points) {
  FlatPoint lower = polygon[0], upper = polygon[0];
  for (const FlatPoint& p : polygon)
    for (std::size_t axis = 0; axis < 2; ++axis) {
      lower[axis] = std::min(lower[axis], p[axis]);
      upper[axis] = std::max(upper[axis], p[axis]);
    }
  for (int i = 0; i < points; ++i) {
    FlatPoint at{};
    for (std::size_t axis = 0; axis < 2; ++axis)
      at[axis] = 3 * lower[axis] +
                 static_cast<std::int64_t>(
                     random() % static_cast<std::uint64_t>(3 * (upper[axis] - lower[axis]) + 1));
    if (is_on_edge(polygon, triangles, at)) continue;
    ASSERT_EQ(cover(polygon, triangles, at), winding(polygon, at)) << at[0] << " " << at[1];
  }
}

/// Splits a simple polygon in every plane, in both orientations and from several first corners.
void expect_split(FlatPolygon polygon, PolygonTriangulator& split) {
  std::mt19937_64 random(polygon.size());
  for (int turn = 0; turn < 3; ++turn) {
    for (const Placement& at : all_placements())
      for (const bool reversed : {false, true}) {
        std::vector<Vec3> corners = placed(polygon, at);
        if (reversed) std::reverse(corners.begin() + 1, corners.end());
        ASSERT_EQ(split.split(corners), PolygonFault::kNone);
        std::vector<CornerTriple> triangles =
            triangles_of(split, static_cast<std::uint32_t>(corners.size()));
        if (reversed)
          for (auto& [a, b, c] : triangles) {
            const auto count = static_cast<std::uint32_t>(corners.size());
            a = (count - a) % count, b = (count - b) % count, c = (count - c) % count;
            std::swap(a, c);
          }
        ASSERT_NO_FATAL_FAILURE(expect_partition(polygon, triangles));
        ASSERT_NO_FATAL_FAILURE(expect_cover(random, polygon, triangles, 20));
      }
    const auto shift = static_cast<std::ptrdiff_t>(1 + random() % (polygon.size() - 1));
    std::rotate(polygon.begin(), polygon.begin() + shift, polygon.end());
  }
}

TEST(PolygonTriangulator, SplitsShapesThatAreNotConvex) {
  PolygonTriangulator split;
  for (const FlatPolygon& polygon : {u_shape(), star(), comb(5, 9), spiral(3), spiral(12)})
    ASSERT_NO_FATAL_FAILURE(expect_split(polygon, split));
}

TEST(PolygonTriangulator, SplitsHolesJoinedByBridges) {
  PolygonTriangulator split;
  for (const std::int64_t across : {1, 2, 3, 5})
    ASSERT_NO_FATAL_FAILURE(expect_split(keyholes(across), split)) << across;
}

TEST(PolygonTriangulator, SplitsRandomSimplePolygons) {
  std::mt19937_64 random(1);
  PolygonTriangulator split;
  for (int i = 0; i < 400; ++i) {
    const std::size_t corners = 4 + random() % 40;
    const std::int64_t range = i % 2 == 0 ? 9 : 1000;
    const FlatPolygon polygon = random_simple(random, corners, range);
    if (polygon.size() > 3) ASSERT_NO_FATAL_FAILURE(expect_split(polygon, split)) << i;
  }
}

TEST(PolygonTriangulator, SplitsOutlinesFullOfSlits) {
  std::mt19937_64 random(2);
  PolygonTriangulator split;
  for (int i = 0; i < 400; ++i) {
    const FlatPolygon polygon = cell_tree(random, 2 + random() % 60);
    ASSERT_NO_FATAL_FAILURE(expect_split(polygon, split)) << i;
  }
}

}  // namespace
}  // namespace planetree::octree
