#include "octree/geometry/child_bounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "octree/builder/tree/float_rounding.h"
#include "octree/traversal/bounds.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

double length(const std::array<float, 3>& v) {
  return std::sqrt(double{v[0]} * v[0] + double{v[1]} * v[1] + double{v[2]} * v[2]);
}

TEST(PackedNormal, RoundTripsAxesExactly) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      double direction[3] = {0, 0, 0};
      direction[axis] = sign;
      const auto back = unpack_normal(pack_normal(direction[0], direction[1], direction[2]));
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(back[k], static_cast<float>(direction[k]));
    }
}

TEST(PackedNormal, RoundTripsDirectionsWithinOneStep) {
  Noise noise(1);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = noise.point(-1, 1);
    const double norm = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    if (norm == 0) continue;
    const auto back = unpack_normal(pack_normal(p.x, p.y, p.z));
    const double along = (back[0] * p.x + back[1] * p.y + back[2] * p.z) / norm;
    EXPECT_GT(along / length(back), 1 - 3e-9);
    EXPECT_NEAR(length(back), 1, 4 * 0x1p-24);
  }
}

TEST(PackedNormal, DecodesAnyBitsToLengthOne) {
  for (const int u : {-32768, -32767, -16384, -1, 0, 1, 12345, 32767})
    for (const int v : {-32768, -32767, -20000, -1, 0, 1, 32766, 32767}) {
      const auto normal =
          unpack_normal({static_cast<std::int16_t>(u), static_cast<std::int16_t>(v)});
      EXPECT_NEAR(length(normal), 1, 4 * 0x1p-24) << u << ' ' << v;
    }
}

TEST(PackedNormal, IsIndependentOfVectorLength) {
  const PackedNormal one = pack_normal(0.3, -0.4, -0.5);
  const PackedNormal other = pack_normal(0.3 * 0x1p-300, -0.4 * 0x1p-300, -0.5 * 0x1p-300);
  EXPECT_EQ(one.u, other.u);
  EXPECT_EQ(one.v, other.v);
}

TEST(PackedChild, DecodesToBoxesInsideTheParents) {
  Noise noise(2);
  for (int i = 0; i < 5000; ++i) {
    FloatBox parent;
    PackedChild child;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double low = noise.uniform(-1, 1);
      parent.lower[axis] = static_cast<float>(low);
      parent.upper[axis] = static_cast<float>(low + noise.uniform(1e-5, 1e-3));
      child.lower[axis] = static_cast<std::uint8_t>(noise.bits() % kBoxSteps);
      child.upper[axis] = static_cast<std::uint8_t>(noise.bits() % (kBoxSteps - child.lower[axis]));
    }
    const FloatBox box = unpack_box(parent, child);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_GE(box.lower[axis], parent.lower[axis]);
      EXPECT_LE(box.lower[axis], box.upper[axis]);
      EXPECT_LE(box.upper[axis], parent.upper[axis]);
    }
  }
}

TEST(PackedChild, WithoutStepsIsTheParentBox) {
  const FloatBox parent{{-0.1f, 0.3f, 1e-7f}, {0.7f, 0.9f, 3e-7f}};
  const FloatBox box = unpack_box(parent, PackedChild{});
  EXPECT_EQ(box.lower, parent.lower);
  EXPECT_EQ(box.upper, parent.upper);
}

TEST(PackedChild, CountsStepsFromBothSides) {
  const FloatBox parent{{0, -255, 510}, {255, 255, 765}};
  PackedChild child;
  child.lower = {1, 2, 3};
  child.upper = {10, 20, 30};
  const FloatBox box = unpack_box(parent, child);
  EXPECT_EQ(box.lower, (std::array<float, 3>{1, -251, 513}));
  EXPECT_EQ(box.upper, (std::array<float, 3>{245, 215, 735}));
}

TEST(Disc, CountsOffsetsInStepsOfTheBox) {
  const FloatBox box{{-1, -1, -1}, {1, 1, 1}};
  PackedChild child;
  child.normal = pack_normal(0, 0, 1);
  child.slab_lower = -32000;
  child.slab_upper = 16000;
  child.radius = 32000;
  const Disc disc = unpack_disc(box, child);
  const double diagonal = 2 * std::sqrt(3.0);
  EXPECT_NEAR(disc.slab_lower, -diagonal, 1e-6);
  EXPECT_NEAR(disc.slab_upper, diagonal / 2, 1e-6);
  EXPECT_NEAR(disc.radius, diagonal, 1e-6);
}

TEST(FloatRounding, EnclosesTheDouble) {
  Noise noise(3);
  for (int i = 0; i < 20000; ++i) {
    const double share = noise.uniform(-1, 1);
    const double value = std::ldexp(share, static_cast<int>(noise.bits() % 200) - 140);
    EXPECT_LE(double{float_below(value)}, value);
    EXPECT_GE(double{float_above(value)}, value);
    EXPECT_LE(float_above(value), std::nextafter(float_below(value), 1e38f));
  }
  EXPECT_EQ(float_below(0.5), 0.5f);
  EXPECT_EQ(float_above(0.5), 0.5f);
}

TEST(FloatRounding, ExtendGrowsTheBox) {
  FloatBox box = empty_box();
  extend(box, Point(1, 2, 3));
  extend(box, Point(-1, 2, 0.1));
  EXPECT_EQ(box.lower, (std::array<float, 3>{-1, 2, float_below(0.1)}));
  EXPECT_EQ(box.upper, (std::array<float, 3>{1, 2, 3}));
  EXPECT_EQ(half_area(FloatBox{{0, 0, 0}, {1, 2, 3}}), 11.0f);
}

// Calls extend() instead of float_below(): compilers merge the three axes into one vector there.
TEST(FloatRounding, EnclosesEveryCoordinateOfAPoint) {
  Noise noise(4);
  std::vector<Point> points;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 p = noise.point(-1, 1);
    points.emplace_back(p.x, p.y, p.z);
  }
  for (const Point& point : points) {
    FloatBox box = empty_box();
    extend(box, point);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = point[static_cast<Eigen::Index>(axis)];
      EXPECT_LE(double{box.lower[axis]}, value);
      EXPECT_GE(double{box.upper[axis]}, value);
    }
  }
}

TEST(Bounds, PruneNothingWhereTheQueryIsTooFarForFloat) {
  const FloatQuery far = FloatQuery::from(0x1p61, 0, 0);
  EXPECT_FALSE(far.usable);
  EXPECT_EQ(prune_threshold(far, 1), std::numeric_limits<float>::infinity());
  EXPECT_EQ(certified(far, 1e30f), 0);
}

// The value of a triangle with an edge of length E errs by up to 2^-42 of it.
TEST(Bounds, AreAsUncertainAsTheLongestStrayAtTheCore) {
  TreeInfo tree;
  const Point query(0.3, -0.2, 0.9);
  const double usual = FloatQuery::from(query, tree).slack;
  tree.set_strays(3, 0);
  EXPECT_EQ(FloatQuery::from(query, tree).slack, usual);
  EXPECT_EQ(tree.span(tree.centre), kMaxDiagonal);
  tree.set_strays(3, 0x1p20);
  EXPECT_GE(FloatQuery::from(query, tree).slack, usual + 0x1p20 * 0x1p-41);
  EXPECT_GE(tree.span(query), 0x1p20);
}

TEST(Bounds, CertifiedDistanceMatchesPruneThreshold) {
  const FloatQuery query = FloatQuery::from(0.3, -0.2, 0.9);
  for (const double distance : {0.0, 1e-12, 1e-3, 0.7, 1e5})
    EXPECT_LE(certified(query, prune_threshold(query, distance)), distance * (1 + 1e-6) + 1e-12);
  // A bound above the threshold certifies at least the distance that the threshold was made for.
  for (const double distance : {1e-3, 0.7, 1e5}) {
    const float above = std::nextafter(prune_threshold(query, distance), 1e38f);
    EXPECT_GE(certified(query, above), distance);
  }
}

}  // namespace
}  // namespace planetree::octree
