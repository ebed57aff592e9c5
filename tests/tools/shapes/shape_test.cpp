#include "tools/shapes/shape_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tools/shapes/shape_holes.h"
#include "tools/shapes/shape_lattice.h"
#include "tools/shapes/shape_noise.h"

namespace planetree::tools {
namespace {

using Edge = std::pair<std::uint64_t, std::uint64_t>;

constexpr ShapeKind kClosedKinds[] = {ShapeKind::kStatue, ShapeKind::kSphere, ShapeKind::kCylinder,
                                      ShapeKind::kCone};
constexpr std::uint64_t kSeed = 7;

std::unique_ptr<Shape> shape_of(ShapeKind kind, std::uint64_t triangles,
                                std::uint64_t seed = kSeed) {
  auto shape = make_shape(kind, triangles, seed);
  return shape ? std::move(*shape) : nullptr;
}

/// Vertex as it is stored in the file.
Vec3 rounded_vertex(const Shape& shape, std::uint64_t index) {
  const Vec3 p = shape.vertex(index);
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

std::array<Vec3, 3> rounded_corners(const Shape& shape, std::uint64_t triangle) {
  const Corners corners = shape.triangle(triangle);
  return {rounded_vertex(shape, corners[0]), rounded_vertex(shape, corners[1]),
          rounded_vertex(shape, corners[2])};
}

Vec3 minus(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(const Vec3& a) { return std::sqrt(dot(a, a)); }

/// Six times the signed volume of the tetrahedron to the origin.
double cone_volume(const std::array<Vec3, 3>& p) { return dot(p[0], cross(p[1], p[2])); }

double volume(const Shape& shape) {
  double sum = 0;
  for (std::uint64_t t = 0; t < shape.triangle_count(); ++t) {
    sum += cone_volume(rounded_corners(shape, t));
  }
  return sum / 6;
}

/// Number of occurrences of each directed edge.
std::map<Edge, int> directed_edges(const Shape& shape) {
  std::map<Edge, int> edges;
  for (std::uint64_t t = 0; t < shape.triangle_count(); ++t) {
    const Corners c = shape.triangle(t);
    for (std::size_t side = 0; side < 3; ++side) ++edges[{c[side], c[(side + 1) % 3]}];
  }
  return edges;
}

/// Number of directed edges without their reverse; -1 if any edge occurs twice.
std::int64_t boundary_edges(const Shape& shape) {
  const std::map<Edge, int> edges = directed_edges(shape);
  std::int64_t boundary = 0;
  for (const auto& [edge, count] : edges) {
    if (count != 1) return -1;
    if (!edges.contains({edge.second, edge.first})) ++boundary;
  }
  return boundary;
}

std::string label(ShapeKind kind, std::uint64_t triangles) {
  return std::string(shape_name(kind)) + " of " + std::to_string(triangles);
}

TEST(Shape, IsWatertightAndConsistentlyOriented) {
  for (const ShapeKind kind : kClosedKinds) {
    for (const std::uint64_t triangles : {1U, 48U, 100U, 192U, 300U, 1000U, 3000U}) {
      SCOPED_TRACE(label(kind, triangles));
      const auto shape = shape_of(kind, triangles);
      EXPECT_EQ(boundary_edges(*shape), 0);
      EXPECT_GT(volume(*shape), 0);
      // One sphere-like surface: V - E + F = 2 with E = 3 F / 2.
      EXPECT_EQ(2 * shape->vertex_count(), shape->triangle_count() + 4);
    }
  }
}

TEST(Shape, UsesEveryVertexAndNoIndexBeyond) {
  for (const ShapeKind kind : kAllShapeKinds) {
    for (const std::uint64_t triangles : {1U, 100U, 1000U}) {
      SCOPED_TRACE(label(kind, triangles));
      const auto shape = shape_of(kind, triangles);
      std::set<std::uint64_t> used;
      for (std::uint64_t t = 0; t < shape->triangle_count(); ++t) {
        for (const std::uint64_t corner : shape->triangle(t)) used.insert(corner);
      }
      EXPECT_EQ(used.size(), shape->vertex_count());
      EXPECT_EQ(*used.rbegin(), shape->vertex_count() - 1);
    }
  }
}

TEST(Shape, VerticesAreDistinctAndTrianglesNondegenerate) {
  for (const ShapeKind kind : kAllShapeKinds) {
    SCOPED_TRACE(shape_name(kind));
    const auto shape = shape_of(kind, 3000);
    std::set<std::array<double, 3>> positions;
    for (std::uint64_t v = 0; v < shape->vertex_count(); ++v) {
      const Vec3 p = rounded_vertex(*shape, v);
      positions.insert({p.x, p.y, p.z});
    }
    EXPECT_EQ(positions.size(), shape->vertex_count());
    for (std::uint64_t t = 0; t < shape->triangle_count(); ++t) {
      const auto p = rounded_corners(*shape, t);
      EXPECT_GT(length(cross(minus(p[1], p[0]), minus(p[2], p[0]))), 0) << t;
    }
  }
}

TEST(Shape, ApproachesTheVolumeOfTheBody) {
  const double ball = 4.0 / 3 * std::numbers::pi * 1e6;
  const double cylinder = std::numbers::pi * 2e6;
  for (const auto& [kind, expected] :
       {std::pair(ShapeKind::kSphere, ball), std::pair(ShapeKind::kCylinder, cylinder),
        std::pair(ShapeKind::kCone, cylinder / 3)}) {
    SCOPED_TRACE(shape_name(kind));
    const auto coarse = shape_of(kind, 3000);
    const auto fine = shape_of(kind, 12000);
    const double coarse_error = 1 - volume(*coarse) / expected;
    const double fine_error = 1 - volume(*fine) / expected;
    EXPECT_GT(fine_error, 0) << "vertices lie on the body, so the mesh is inside";
    EXPECT_LT(fine_error, 0.004);
    // Chords cut off an area proportional to their squared length, so to 1 / triangles.
    const double finer =
        static_cast<double>(fine->triangle_count()) / static_cast<double>(coarse->triangle_count());
    EXPECT_NEAR(coarse_error / fine_error, finer, 0.05 * finer);
  }
}

TEST(Shape, MakesTheStatueStarShapedAndRough) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const auto statue = shape_of(ShapeKind::kStatue, 20000, seed);
    for (std::uint64_t t = 0; t < statue->triangle_count(); ++t) {
      ASSERT_GT(cone_volume(rounded_corners(*statue, t)), 0) << t;
    }
    double least = 1e9, greatest = 0;
    for (std::uint64_t v = 0; v < statue->vertex_count(); ++v) {
      least = std::min(least, length(statue->vertex(v)));
      greatest = std::max(greatest, length(statue->vertex(v)));
    }
    EXPECT_GT(least, 65);
    EXPECT_LT(least, 85);
    EXPECT_GT(greatest, 115);
    EXPECT_LT(greatest, 135);
  }
}

TEST(Shape, MakesTheTerrainAGraphWithOneBoundary) {
  for (const std::uint64_t triangles : {1U, 200U, 3000U}) {
    const auto terrain = shape_of(ShapeKind::kTerrain, triangles);
    const auto n = static_cast<std::int64_t>(std::sqrt(terrain->triangle_count() / 2) + 0.5);
    EXPECT_EQ(boundary_edges(*terrain), 4 * n);
    for (std::uint64_t t = 0; t < terrain->triangle_count(); ++t) {
      const auto p = rounded_corners(*terrain, t);
      EXPECT_GT(cross(minus(p[1], p[0]), minus(p[2], p[0])).z, 0) << t;
    }
  }
}

TEST(Shape, ScattersTheSoupInTheUnitCube) {
  const auto soup = shape_of(ShapeKind::kSoup, 1000);
  ASSERT_EQ(soup->triangle_count(), 1000U);
  Vec3 sum;
  for (std::uint64_t v = 0; v < soup->vertex_count(); ++v) {
    const Vec3 p = soup->vertex(v);
    EXPECT_TRUE(p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1 && p.z >= 0 && p.z <= 1) << v;
    sum = {sum.x + p.x, sum.y + p.y, sum.z + p.z};
  }
  for (const double mean : {sum.x / 3000, sum.y / 3000, sum.z / 3000}) {
    EXPECT_NEAR(mean, 0.5, 0.04);
  }
  for (std::uint64_t t = 0; t < soup->triangle_count(); ++t) {
    const auto p = rounded_corners(*soup, t);
    EXPECT_LT(length(minus(p[1], p[0])), 0.1 * std::sqrt(3));
  }
}

TEST(Shape, HasAboutTheRequestedNumberOfTriangles) {
  for (const ShapeKind kind : kAllShapeKinds) {
    // From one lattice size to the next the count grows by about twice this.
    const double per_square = kind == ShapeKind::kTerrain ? 2 : kind == ShapeKind::kCone ? 16 : 12;
    for (std::uint64_t triangles = 1; triangles < 1'400'000'000;
         triangles = triangles * 7 / 3 + 1) {
      SCOPED_TRACE(label(kind, triangles));
      const auto shape = shape_of(kind, triangles);
      ASSERT_NE(shape, nullptr);
      const double requested = static_cast<double>(triangles);
      const double slack =
          kind == ShapeKind::kSoup ? 0 : std::sqrt(per_square * requested) + per_square;
      EXPECT_NEAR(static_cast<double>(shape->triangle_count()), requested, slack);
    }
  }
}

TEST(Shape, StaysLocalAtBillionsOfTriangles) {
  for (const ShapeKind kind : {ShapeKind::kStatue, ShapeKind::kSphere, ShapeKind::kCylinder,
                               ShapeKind::kCone, ShapeKind::kTerrain}) {
    SCOPED_TRACE(shape_name(kind));
    const auto shape = shape_of(kind, 8'500'000'000);
    ASSERT_NE(shape, nullptr);
    const std::uint64_t count = shape->triangle_count();
    for (int sample = 0; sample < 3000; ++sample) {
      const double part = random_unit(kSeed, static_cast<std::uint64_t>(sample));
      const auto t = std::min(
          count - 1, static_cast<std::uint64_t>(part * 1.001 * static_cast<double>(count)));
      const Corners corners = shape->triangle(t);
      for (std::size_t side = 0; side < 3; ++side) {
        ASSERT_LT(corners[side], shape->vertex_count()) << t;
        const Vec3 edge =
            minus(shape->vertex(corners[side]), shape->vertex(corners[(side + 1) % 3]));
        ASSERT_GT(length(edge), 1e-3) << t;
        ASSERT_LT(length(edge), 0.3) << t;
      }
    }
  }
}

TEST(Shape, RefusesZeroAndTooManyTriangles) {
  for (const ShapeKind kind : kAllShapeKinds) {
    SCOPED_TRACE(shape_name(kind));
    for (const std::uint64_t triangles :
         {std::uint64_t{0}, std::uint64_t{10'000'000'000}, ~std::uint64_t{0}}) {
      const auto shape = make_shape(kind, triangles, kSeed);
      ASSERT_FALSE(shape) << triangles;
      EXPECT_EQ(shape.error().code, ErrorCode::kBadArgument);
    }
  }
  // Three vertices a triangle: the last that 32 bits can index, and one more.
  EXPECT_TRUE(make_shape(ShapeKind::kSoup, 1'431'655'765, kSeed));
  EXPECT_FALSE(make_shape(ShapeKind::kSoup, 1'431'655'766, kSeed));
}

TEST(Shape, DependsOnTheSeedWhereItShould) {
  for (const ShapeKind kind : kAllShapeKinds) {
    SCOPED_TRACE(shape_name(kind));
    const auto one = shape_of(kind, 1000, 1);
    const auto two = shape_of(kind, 1000, 2);
    std::uint64_t changed = 0;
    for (std::uint64_t v = 0; v < one->vertex_count(); ++v) {
      changed += length(minus(one->vertex(v), two->vertex(v))) > 0 ? 1 : 0;
    }
    const bool random =
        kind == ShapeKind::kStatue || kind == ShapeKind::kTerrain || kind == ShapeKind::kSoup;
    EXPECT_EQ(changed, random ? one->vertex_count() : 0);
  }
}

TEST(Shape, NamesRoundTrip) {
  for (const ShapeKind kind : kAllShapeKinds) EXPECT_EQ(shape_named(shape_name(kind)), kind);
  EXPECT_EQ(shape_name(ShapeKind::kSoup), "soup");
  EXPECT_FALSE(shape_named("Statue"));
  EXPECT_FALSE(shape_named(""));
}

TEST(ShapeHoles, LeaveOutOneTriangleOfEachStretch) {
  const auto whole = shape_of(ShapeKind::kSphere, 1000);
  const std::uint64_t count = whole->triangle_count();
  std::map<Corners, std::uint64_t> index;
  for (std::uint64_t i = 0; i < count; ++i) index[whole->triangle(i)] = i;
  for (const std::uint64_t holes :
       {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{7}, count / 3, count / 2}) {
    const HoledShape holed(shape_of(ShapeKind::kSphere, 1000), holes, kSeed);
    ASSERT_EQ(holed.triangle_count(), count - holes);
    const std::uint64_t size = holes == 0 ? count : count / holes;
    std::set<std::uint64_t> stretches;
    std::uint64_t next = 0;
    const auto leave_out_until = [&](std::uint64_t end) {
      for (; next < end; ++next) EXPECT_TRUE(stretches.insert(next / size).second);
    };
    for (std::uint64_t i = 0; i < holed.triangle_count(); ++i) {
      const std::uint64_t at = index.at(holed.triangle(i));
      ASSERT_GE(at, next);
      leave_out_until(at);
      next = at + 1;
    }
    leave_out_until(count);
    EXPECT_EQ(stretches.size(), holes);
  }
}

}  // namespace
}  // namespace planetree::tools
