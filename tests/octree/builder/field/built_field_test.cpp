#include "octree/builder/field/built_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "octree/geometry/triangle_distance.h"
#include "tests/octree/builder/field/sample_field.h"

namespace planetree::octree {
namespace {

double distance(const SampleMesh& mesh, const Point& from) {
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < mesh.size(); ++i)
    least = std::min(least, triangle_value(from, mesh.corners(i)).squared);
  return std::sqrt(least);
}

void expect_nearest_points(const SampleField& sample) {
  const FieldShape& shape = sample.field.shape();
  ASSERT_EQ(sample.field.points().size(), shape.count());
  for (std::uint64_t i = 0; i < shape.count(); i += 5) {
    const Point at = shape.lower + shape.at(i);
    const Point stored = shape.lower + shape.surface_point(sample.field.points()[i]);
    EXPECT_NEAR((at - stored).norm(), distance(sample.tree->mesh, at), 0.875 * shape.quantum);
    EXPECT_LE(distance(sample.tree->mesh, stored), 0.875 * shape.quantum);
  }
}

TEST(BuiltField, HasTheNearestPointOfEachGridPoint) {
  expect_nearest_points(SampleField::of_sphere());
  expect_nearest_points(SampleField(scattered(2000, 0.1)));
}

TEST(BuiltField, CoversTheRegionOfAFile) {
  Soup soup = sphere(6);
  std::erase_if(soup, [](const auto& triangle) { return triangle[0].z < 0.25; });
  const Region region(Point(-2, -2, 0.25), Point(2, 2, 2), Point(-1, -1, -1), Point(1, 1, 1));
  const SampleField sample(soup, region);
  const FieldShape& shape = sample.field.shape();
  ASSERT_GT(shape.count(), 0u);
  EXPECT_GT(shape.lower.z(), -0.4);
  EXPECT_LT(shape.lower.x(), -1);
}

TEST(BuiltField, IsEmptyForFewTriangles) {
  const SampleField sample(sphere(3));
  EXPECT_EQ(sample.field.page_count(), 0u);
  storage::ModelRecord model{};
  sample.field.describe(model);
  EXPECT_EQ(model.field_page_count, 0u);
  EXPECT_EQ(model.field_step, 0);
}

// A search would have to look at all of them.
TEST(BuiltField, IsEmptyForManyTrianglesInOnePlace) {
  EXPECT_EQ(SampleField(octree::repeated(50000)).field.page_count(), 0u);
}

// A grid about a region far from the surface could not store the nearest points.
TEST(BuiltField, IsEmptyWhereSurfaceIsOutOfReach) {
  const Region region(Point(-1, -1, 0.99), Point(-0.9, -0.9, 1), Point(-1, -1, -1), Point(1, 1, 1));
  EXPECT_EQ(SampleField(sphere(5), region).field.page_count(), 0u);
}

// Far from the origin grid points and surface points are rounded, by more than a field allows.
TEST(BuiltField, IsEmptyFarFromTheOrigin) {
  for (const auto& [offset, has_field] :
       {std::pair{0x1p20, true}, std::pair{0x1p24, true}, std::pair{0x1p30, false}}) {
    Soup soup = sphere(4);
    for (auto& triangle : soup)
      for (Vec3& corner : triangle) corner.x += offset;
    const SampleField sample(soup);
    EXPECT_EQ(sample.field.page_count() > 0, has_field) << offset;
    if (has_field) expect_nearest_points(sample);
  }
}

}  // namespace
}  // namespace planetree::octree
