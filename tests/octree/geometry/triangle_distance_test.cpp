#include "octree/geometry/triangle_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

Point to_point(const Vec3& p) { return {p.x, p.y, p.z}; }

Triangle random_triangle(Noise& noise, double extent = 1) {
  Triangle triangle;
  for (Point& corner : triangle) corner = to_point(noise.point(-extent, extent));
  return triangle;
}

const Triangle kRight{Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)};

TEST(TriangleDistance, FindsTheFaceBelow) {
  const NearestOnTriangle nearest = nearest_on_triangle({0.25, 0.25, -3}, kRight);
  EXPECT_EQ(nearest.feature, Feature::kFace);
  EXPECT_EQ(nearest.value.squared, 9);
  EXPECT_EQ(nearest.point, Point(0.25, 0.25, 0));
  EXPECT_EQ(nearest.barycentric, (std::array<double, 3>{0.5, 0.25, 0.25}));
}

// The error of a value is at least 32 u of the farthest corner's distance, over the sine at the
// corner of the largest angle.
TEST(TriangleDistance, ErrorsCoverTheRoundingOfTheFarthestCorner) {
  for (const double far : {0.5, 3.0, 1000.0}) {
    const double farthest = std::sqrt(0.75 * 0.75 + 0.25 * 0.25 + far * far);
    const double error = nearest_on_triangle({0.25, 0.25, -far}, kRight).value.error;
    EXPECT_GE(error, 32 * 0x1p-53 * farthest);
    EXPECT_LE(error, 128 * 0x1p-53 * farthest);
  }
}

TEST(TriangleDistance, FindsEachEdge) {
  struct Row {
    Point query, point;
    std::array<double, 3> barycentric;
  };
  const Row rows[] = {{{0.5, -2, 0}, {0.5, 0, 0}, {0.5, 0.5, 0}},
                      {{-1, 0.25, 1}, {0, 0.25, 0}, {0.75, 0, 0.25}},
                      {{1, 1, 0}, {0.5, 0.5, 0}, {0, 0.5, 0.5}}};
  for (const Row& row : rows) {
    const NearestOnTriangle nearest = nearest_on_triangle(row.query, kRight);
    EXPECT_EQ(nearest.feature, Feature::kEdge);
    EXPECT_EQ(nearest.point, row.point);
    EXPECT_EQ(nearest.barycentric, row.barycentric);
    EXPECT_EQ(nearest.value.squared, (row.query - row.point).squaredNorm());
  }
}

TEST(TriangleDistance, FindsEachVertex) {
  const Point queries[] = {{-1, -1, 1}, {3, -1, 0}, {-1, 4, 0}};
  for (std::size_t k = 0; k < 3; ++k) {
    const NearestOnTriangle nearest = nearest_on_triangle(queries[k], kRight);
    EXPECT_EQ(nearest.feature, Feature::kVertex);
    EXPECT_EQ(nearest.point, kRight[k]);
    EXPECT_EQ(nearest.barycentric[k], 1);
  }
}

TEST(TriangleDistance, IsZeroOnTheTriangle) {
  EXPECT_EQ(triangle_value({0.25, 0.5, 0}, kRight).squared, 0);
  EXPECT_EQ(triangle_value({0.5, 0, 0}, kRight).squared, 0);
  EXPECT_EQ(triangle_value({0, 1, 0}, kRight).squared, 0);
}

TEST(TriangleDistance, BarycentricWeightsSumToOneAndGiveThePoint) {
  Noise noise(1);
  for (int i = 0; i < 5000; ++i) {
    const Triangle triangle = random_triangle(noise);
    const NearestOnTriangle nearest = nearest_on_triangle(to_point(noise.point(-2, 2)), triangle);
    const auto& [a, b, c] = nearest.barycentric;
    EXPECT_NEAR(a + b + c, 1, 4e-16);
    for (const double weight : nearest.barycentric) {
      EXPECT_GE(weight, -4e-16);
      EXPECT_LE(weight, 1);
    }
    const Point made = a * triangle[0] + b * triangle[1] + c * triangle[2];
    EXPECT_LE((made - nearest.point).norm(), 4e-15);
  }
}

TEST(TriangleDistance, ValueMatchesDistanceToThePoint) {
  Noise noise(2);
  for (int i = 0; i < 5000; ++i) {
    const Triangle triangle = random_triangle(noise);
    const Point query = to_point(noise.point(-2, 2));
    const NearestOnTriangle nearest = nearest_on_triangle(query, triangle);
    EXPECT_EQ(bits(nearest.value.squared), bits(triangle_value(query, triangle).squared));
    EXPECT_NEAR((nearest.point - query).norm(), std::sqrt(nearest.value.squared),
                nearest.value.error + 1e-15);
  }
}

TEST(TriangleDistance, GivesTheSameBitsInAnyOrderOfCorners) {
  Noise noise(3);
  for (int i = 0; i < 2000; ++i) {
    Triangle triangle = random_triangle(noise);
    // Also needles and triangles with equal corners.
    if (i % 4 == 1) triangle[2] = triangle[0] + 1e-9 * (triangle[2] - triangle[1]);
    if (i % 4 == 2) triangle[2] = triangle[1];
    if (i % 4 == 3)
      for (Point& corner : triangle) corner = (corner * 2).array().round() / 2;
    const Point query = to_point(noise.point(-1.5, 1.5));
    const NearestOnTriangle first = nearest_on_triangle(query, triangle);
    std::array<std::size_t, 3> order{0, 1, 2};
    do {
      const NearestOnTriangle other =
          nearest_on_triangle(query, {triangle[order[0]], triangle[order[1]], triangle[order[2]]});
      EXPECT_EQ(bits(other.value.squared), bits(first.value.squared));
      EXPECT_EQ(bits(other.value.error), bits(first.value.error));
      EXPECT_EQ(other.feature, first.feature);
      EXPECT_EQ(other.point, first.point);
      if (i % 4 > 1) continue;  // equal corners may exchange their weights
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(bits(other.barycentric[k]), bits(first.barycentric[order[k]]));
    } while (std::ranges::next_permutation(order).found);
  }
}

TEST(TriangleDistance, GivesSharedEdgesTheSameBits) {
  Noise noise(4);
  int edges = 0;
  for (int i = 0; i < 20000; ++i) {
    Triangle one = random_triangle(noise), other = random_triangle(noise);
    other[2] = one[0];
    other[0] = one[1];
    const Point query = to_point(noise.point(-3, 3));
    const NearestOnTriangle a = nearest_on_triangle(query, one);
    const NearestOnTriangle b = nearest_on_triangle(query, other);
    if (a.feature != Feature::kEdge || a.barycentric[2] != 0) continue;
    if (b.feature != Feature::kEdge || b.barycentric[1] != 0) continue;
    ++edges;
    EXPECT_EQ(bits(a.value.squared), bits(b.value.squared));
    EXPECT_EQ(a.point, b.point);
  }
  EXPECT_GT(edges, 200);
}

TEST(TriangleDistance, GivesSharedVerticesTheSameBits) {
  Noise noise(5);
  int vertices = 0;
  for (int i = 0; i < 5000; ++i) {
    Triangle one = random_triangle(noise), other = random_triangle(noise);
    other[1] = one[0];
    const Point query = to_point(noise.point(-3, 3));
    const NearestOnTriangle a = nearest_on_triangle(query, one);
    const NearestOnTriangle b = nearest_on_triangle(query, other);
    if (a.feature != Feature::kVertex || a.point != one[0]) continue;
    if (b.feature != Feature::kVertex || b.point != one[0]) continue;
    ++vertices;
    EXPECT_EQ(bits(a.value.squared), bits(b.value.squared));
    EXPECT_EQ(bits(a.value.squared), bits((one[0] - query).squaredNorm()));
  }
  EXPECT_GT(vertices, 50);
}

TEST(TriangleDistance, TreatsFlatTrianglesAsSegments) {
  const Triangle segment{Point(0, 0, 0), Point(2, 0, 0), Point(1, 0, 0)};
  const NearestOnTriangle nearest = nearest_on_triangle({0.5, 3, 4}, segment);
  EXPECT_EQ(nearest.value.squared, 25);
  EXPECT_EQ(nearest.point, Point(0.5, 0, 0));
  EXPECT_NE(nearest.feature, Feature::kFace);
}

TEST(TriangleDistance, TreatsPointTrianglesAsVertices) {
  const Triangle dot{Point(1, 1, 1), Point(1, 1, 1), Point(1, 1, 1)};
  const NearestOnTriangle nearest = nearest_on_triangle({1, 1, 3}, dot);
  EXPECT_EQ(nearest.value.squared, 4);
  EXPECT_EQ(nearest.feature, Feature::kVertex);
  EXPECT_EQ(nearest.barycentric[0] + nearest.barycentric[1] + nearest.barycentric[2], 1);
}

TEST(TriangleDistance, FindsTheFaceOfANeedle) {
  // 2^-26 wide: the face is too flat for double, and the edges alone would give 1 + 2^-56.
  const double width = 0x1p-26;
  const Triangle needle{Point(-1, 0, 0), Point(1, 0, 0), Point(0, width, 0)};
  const NearestOnTriangle nearest = nearest_on_triangle({0, width / 2, 1}, needle);
  EXPECT_EQ(nearest.feature, Feature::kFace);
  EXPECT_EQ(nearest.value.squared, 1);
}

TEST(TriangleDistance, ScalesByPowersOfTwoBitForBit) {
  Noise noise(6);
  for (int i = 0; i < 500; ++i) {
    Triangle triangle = random_triangle(noise);
    Point query = to_point(noise.point(-2, 2));
    const double squared = triangle_value(query, triangle).squared;
    for (Point& corner : triangle) corner *= 0x1p-60;
    query *= 0x1p-60;
    EXPECT_EQ(bits(triangle_value(query, triangle).squared), bits(squared * 0x1p-120));
  }
}

}  // namespace
}  // namespace planetree::octree
