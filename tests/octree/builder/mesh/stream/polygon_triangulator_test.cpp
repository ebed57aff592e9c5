#include "octree/builder/mesh/stream/polygon_triangulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
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

const Placement kGround = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

TEST(PolygonTriangulator, TakesTheFanWhereItCoversThePolygon) {
  PolygonTriangulator split;
  const FlatPolygon polygons[] = {
      {{0, 0}, {3, 0}, {3, 3}, {0, 3}},                            // a square
      {{0, 0}, {4, 0}, {1, 1}, {0, 4}},                            // an arrow head, from its tail
      {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 0}},                    // the first corner again
      {{0, 0}, {3, 0}, {3, 0}, {3, 3}},                            // a corner twice
      {{0, 0}, {1, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 1}},            // corners on sides
      {{0, 0}, {4, 0}, {2, 1}, {4, 4}, {0, 2}, {-2, 3}, {-4, 0}},  // star-shaped
      {{0, 0}, {1, 0}, {2, 0}, {3, 0}},                            // on a line
      {{5, 5}, {5, 5}, {5, 5}, {5, 5}},                            // in a point
  };
  for (const FlatPolygon& polygon : polygons)
    for (const Placement& at : all_placements()) {
      EXPECT_EQ(split.split(placed(polygon, at)), PolygonFault::kNone) << polygon.size();
      EXPECT_TRUE(split.is_fan()) << polygon.size();
    }
}

TEST(PolygonTriangulator, DividesADartFromItsReflexCorner) {
  PolygonTriangulator split;
  const FlatPolygon dart = {{4, 0}, {1, 1}, {0, 4}, {0, 0}};
  ASSERT_EQ(split.split(placed(dart, kGround)), PolygonFault::kNone);
  const std::vector<CornerTriple> expected = {{3, 0, 1}, {1, 2, 3}};
  EXPECT_TRUE(std::ranges::equal(split.triangles(), expected));
}

TEST(PolygonTriangulator, CutsSpikesWhereverTheyPoint) {
  PolygonTriangulator split;
  // Spikes inwards, outwards and along a side, one of them with a bend, and a corner three times.
  const FlatPolygon polygon = {{0, 0}, {6, 0}, {9, 0}, {6, 0}, {6, 4}, {4, 2}, {3, 3},
                               {4, 2}, {6, 4}, {6, 6}, {3, 6}, {3, 9}, {3, 6}, {1, 6},
                               {5, 6}, {0, 6}, {0, 6}, {0, 6}, {2, 5}};
  ASSERT_NO_FATAL_FAILURE(expect_split(polygon, split));
  // Nothing but spikes.
  const FlatPolygon tree = {{0, 0}, {3, 1}, {5, 0}, {3, 1}, {4, 4}, {3, 1}};
  EXPECT_EQ(split.split(placed(tree, kGround)), PolygonFault::kNone);
  ASSERT_FALSE(split.is_fan());
  for (const auto& [a, b, c] : split.triangles()) EXPECT_EQ(area_of(tree[a], tree[b], tree[c]), 0);
}

TEST(PolygonTriangulator, LeavesPolygonsThatCrossThemselvesAsFans) {
  PolygonTriangulator split;
  FlatPolygon windings;
  for (int k = 0; k < 1000; ++k) windings.insert(windings.end(), {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  const FlatPolygon polygons[] = {
      {{0, 0}, {4, 4}, {4, 0}, {0, 4}},              // a bow tie
      {{0, 0}, {6, 4}, {4, 0}, {0, 4}},              // one with unequal halves
      {{0, 9}, {5, -7}, {-8, 3}, {8, 3}, {-5, -7}},  // a pentagram
      {{0, 0}, {8, 0}, {8, 8}, {4, -4}, {2, 8}},     // sides that cross the base
      windings,
  };
  for (const FlatPolygon& polygon : polygons)
    for (const Placement& at : all_placements()) {
      EXPECT_EQ(split.split(placed(polygon, at)), PolygonFault::kCrossing) << polygon.size();
      EXPECT_TRUE(split.is_fan()) << polygon.size();
    }
}

TEST(PolygonTriangulator, TellsConcavePolygonsThatAreNotFlat) {
  PolygonTriangulator split;
  for (const Placement& at : all_placements()) {
    std::vector<Vec3> corners = placed(u_shape(), at);
    const Vec3 u = at.along_u, v = at.along_v;
    const Vec3 normal = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    const double length = std::max({std::fabs(normal.x), std::fabs(normal.y), std::fabs(normal.z)});
    if (!(length > 0x1p-30 && length < 0x1p30) || std::fabs(at.origin.x) > 100) continue;
    for (const auto& [share, fault] :
         {std::pair(0x1p-26, PolygonFault::kNone), std::pair(0.25, PolygonFault::kNotPlanar)}) {
      std::vector<Vec3> bent = corners;
      bent[4] = {bent[4].x + share * normal.x / length, bent[4].y + share * normal.y / length,
                 bent[4].z + share * normal.z / length};
      EXPECT_EQ(split.split(bent), fault);
      EXPECT_FALSE(split.is_fan());
    }
  }
  // A fan is a fan whether flat or not.
  const std::vector<Vec3> saddle = {{0, 0, 0}, {1, 0, 1}, {1, 1, 0}, {0, 1, 1}};
  EXPECT_EQ(split.split(saddle), PolygonFault::kNone);
  EXPECT_TRUE(split.is_fan());
}

TEST(PolygonTriangulator, SplitsLargePolygonsInLittleTime) {
  PolygonTriangulator split;
  for (const FlatPolygon& polygon : {comb(20000, 10), spiral(5000), keyholes(50)}) {
    ASSERT_EQ(split.split(placed(polygon, kGround)), PolygonFault::kNone) << polygon.size();
    const auto triangles = split.triangles();
    ASSERT_NO_FATAL_FAILURE(
        expect_partition(polygon, std::vector(triangles.begin(), triangles.end())));
  }
}

TEST(PolygonTriangulator, SplitsRandomSimplePolygons) {
  std::mt19937_64 random(1);
  PolygonTriangulator split;
  for (int i = 0; i < 400; ++i) {
    const std::size_t corners = 4 + random() % 40;
    const std::int64_t range = i % 2 == 0 ? 9 : 1000;
    const FlatPolygon polygon = random_simple(random, corners, range);
    if (polygon.size() == 3) continue;
    ASSERT_NO_FATAL_FAILURE(expect_split(polygon, split)) << i;
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
