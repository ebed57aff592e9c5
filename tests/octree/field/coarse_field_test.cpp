#include "octree/field/coarse_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A field of points, so that the nearest surface point is found by hand.
class PointCloud {
 public:
  explicit PointCloud(std::vector<Point> points, std::uint64_t triangles = 20000)
      : points_(std::move(points)),
        shape_(FieldShape::of(Point(-1, -1, -1), Point(1, 1, 0.5), triangles)) {
    for (std::uint64_t i = 0; i < shape_.count(); ++i) {
      const Point at = nearest(shape_.lower + shape_.at(i));
      const Point quanta = (at - shape_.lower) / shape_.quantum;
      FieldPoint stored{};
      for (unsigned axis = 0; axis < 3; ++axis)
        stored[axis] = static_cast<std::uint16_t>(std::floor(quanta[axis] + 0.5));
      stored_.push_back(stored);
    }
  }

  Point nearest(const Point& from) const {
    return *std::ranges::min_element(
        points_, {}, [&](const Point& point) { return (point - from).squaredNorm(); });
  }
  CoarseField field(bool has_strays = false) const {
    CoarseField field;
    field.fill(shape_, stored_, has_strays);
    return field;
  }
  const FieldShape& shape() const { return shape_; }
  /// The same with every n-th point along each axis.
  PointCloud thinned(std::uint32_t n) const {
    PointCloud cloud = *this;
    cloud.shape_ = shape_.thinned(n);
    cloud.stored_.clear();
    for (std::uint32_t k = 0; k < shape_.size[2]; k += n)
      for (std::uint32_t j = 0; j < shape_.size[1]; j += n)
        for (std::uint32_t i = 0; i < shape_.size[0]; i += n)
          cloud.stored_.push_back(stored_[shape_.index_of(i, j, k)]);
    EXPECT_EQ(cloud.stored_.size(), cloud.shape_.count());
    return cloud;
  }

 private:
  std::vector<Point> points_;
  FieldShape shape_;
  std::vector<FieldPoint> stored_;
};

PointCloud random_cloud(std::size_t count) {
  Noise noise(1);
  std::vector<Point> points;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p = noise.point(-1, 1);
    points.emplace_back(p.x, p.y, p.z / 4 - 0.25);
  }
  return PointCloud(std::move(points));
}

TEST(CoarseField, BoundsHoldInTheGridAndOutside) {
  Noise noise(2);
  for (const std::size_t count : {1, 2, 10, 300}) {
    const PointCloud whole = random_cloud(count);
    const PointCloud cloud = count == 10 ? whole.thinned(2) : whole;
    const CoarseField field = cloud.field();
    for (const double reach : {0.5, 1.5, 5.0, 1e6}) {
      for (int i = 0; i < 300; ++i) {
        const Vec3 p = noise.point(-reach, reach);
        const Point query(p.x, p.y, p.z);
        const double distance = (cloud.nearest(query) - query).norm();
        const FieldBounds bounds = field.bounds(query);
        ASSERT_TRUE(bounds.are_known());
        EXPECT_LE(bounds.lower, distance);
        EXPECT_GE(bounds.upper, distance);
        EXPECT_GE(bounds.upper, (bounds.point - query).norm());
        EXPECT_GE(field.estimate(query).upper, distance);
      }
    }
  }
}

// Both ends err by the square of the step over the distance.
TEST(CoarseField, IsNarrowFarFromTheSurface) {
  const PointCloud cloud({Point(-0.9, -0.9, -0.9)});
  const CoarseField field = cloud.field();
  const double step = cloud.shape().step;
  for (double at = -0.5; at < 1; at += 0.01) {
    const FieldBounds bounds = field.bounds(Point(at, at, 0.1));
    EXPECT_LT(bounds.upper - bounds.lower, step * step / bounds.lower + 4 * cloud.shape().quantum);
  }
}

TEST(CoarseField, HoldsAtGridPointsAndAnUlpBeside) {
  const PointCloud cloud = random_cloud(50);
  const CoarseField field = cloud.field();
  for (std::uint64_t i = 0; i < cloud.shape().count(); i += 7) {
    const Point at = cloud.shape().lower + cloud.shape().at(i);
    for (const double towards : {-kInfinity, 0.0, kInfinity}) {
      Point query = at;
      if (towards != 0)
        for (double& coordinate : query) coordinate = std::nextafter(coordinate, towards);
      const double distance = (cloud.nearest(query) - query).norm();
      const FieldBounds bounds = field.bounds(query);
      EXPECT_LE(bounds.lower, distance);
      EXPECT_GE(bounds.upper, distance);
    }
  }
}

// Rounding to quanta moves a point the most if each coordinate is half a quantum off. Seen along
// the diagonal, it is then nearer or farther by all of sqrt(3) / 2 quanta.
TEST(CoarseField, BoundsHoldWhereRoundingIsGreatest) {
  const FieldShape shape = PointCloud({Point::Zero()}).shape();
  const Point diagonal = Point::Constant(shape.quantum);
  for (const double number : {9000, 14000, 20011}) {
    // Stored half a quantum above.
    const PointCloud cloud({shape.lower + diagonal * (number + 0.5 + 1e-6)});
    const Point surface = cloud.nearest(Point::Zero());
    const CoarseField field = cloud.field();
    double least_lower = kInfinity, least_upper = kInfinity;
    for (const double steps : {-30000.0, -8000.0, 8000.0, 30000.0}) {
      // From the grid point that is next on the diagonal, as nothing is interpolated there.
      const double whole = std::round((number + steps) * shape.quantum / shape.step);
      const Point query = shape.lower + Point::Constant(whole * shape.step);
      const double distance = (query - surface).norm();
      const FieldBounds bounds = field.bounds(query);
      EXPECT_LE(bounds.lower, distance);
      EXPECT_GE(bounds.upper, distance);
      EXPECT_GE(field.estimate(query).upper, distance);
      EXPECT_GE(field.upper_bound(query).upper, distance);
      least_lower = std::min(least_lower, distance - bounds.lower);
      least_upper = std::min(least_upper, bounds.upper - distance);
    }
    // Little is spare: none of these would hold with an uncertainty of sqrt(3) / 2.
    EXPECT_LT(least_lower, 0.1 * shape.quantum);
    EXPECT_LT(least_upper, 0.1 * shape.quantum);
  }
}

// There the rounding of float is more than the uncertainty.
TEST(CoarseField, BoundsHoldFarAway) {
  Noise noise(3);
  const PointCloud cloud({Point(0.3, 0.2, 0.1)});
  const CoarseField field = cloud.field();
  for (const double reach : {0x1p10, 0x1p20, 0x1p30})
    for (int i = 0; i < 3000; ++i) {
      const Vec3 p = noise.point(-reach, reach);
      const Point query(p.x, p.y, p.z);
      const double distance = (query - cloud.nearest(query)).norm();
      const FieldBounds bounds = field.bounds(query);
      EXPECT_LE(bounds.lower, distance);
      EXPECT_GE(bounds.upper, distance);
      EXPECT_LE(bounds.upper, distance * (1 + 0x1p-18) + cloud.shape().quantum * 2);
      const FieldBounds one = field.upper_bound(query);
      EXPECT_GE(one.upper, distance);
      EXPECT_LE(one.upper, distance * (1 + 0x1p-38) + cloud.shape().quantum * 2);
      EXPECT_EQ(one.upper, field.estimate(query).upper);
    }
}

// A stray may be anywhere outside, so that nothing is known there but an upper bound.
TEST(CoarseField, HasNoLowerBoundOutsideBesideStrays) {
  const PointCloud cloud = random_cloud(50);
  const CoarseField field = cloud.field(true);
  EXPECT_EQ(field.bounds(Point(3, 0, 0)).lower, 0);
  EXPECT_LT(field.bounds(Point(3, 0, 0)).upper, 5);
  EXPECT_GT(field.bounds(Point(0.9, 0.9, 0.6)).lower, 0);
}

TEST(CoarseField, TellsNothingWithoutPointsAndVeryFarAway) {
  EXPECT_FALSE(CoarseField().bounds(Point(0, 0, 0)).are_known());
  EXPECT_EQ(CoarseField().estimate(Point(0, 0, 0)).upper, kInfinity);
  EXPECT_FALSE(CoarseField().upper_bound(Point(0, 0, 0)).are_known());
  const PointCloud cloud = random_cloud(50);
  for (const double far : {1e20, 1e150, 1e300}) {
    EXPECT_FALSE(cloud.field().bounds(Point(0, far, 0)).are_known());
    EXPECT_EQ(cloud.field().estimate(Point(0, -far, 0)).upper, kInfinity);
  }
}

// Each bound is tight: rounded inward by a quantum, it no longer holds somewhere.
TEST(CoarseField, BoundsHaveLittleSlack) {
  const PointCloud cloud({Point(0.3, 0.2, 0.1)});
  const CoarseField field = cloud.field();
  double least_lower = kInfinity, least_upper = kInfinity;
  for (std::uint64_t i = 0; i < cloud.shape().count(); ++i) {
    const Point at = cloud.shape().lower + cloud.shape().at(i);
    const double distance = (cloud.nearest(at) - at).norm();
    least_lower = std::min(least_lower, distance - field.bounds(at).lower);
    least_upper = std::min(least_upper, field.bounds(at).upper - distance);
  }
  EXPECT_LT(least_lower, cloud.shape().quantum);
  EXPECT_LT(least_upper, cloud.shape().quantum);
}

}  // namespace
}  // namespace planetree::octree
