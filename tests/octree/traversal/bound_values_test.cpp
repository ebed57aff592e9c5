// Bounds of boxes and discs beside values that are known by hand.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "octree/geometry/error_bounds.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/node_kernels-inl.h"

namespace planetree::octree {
namespace {

constexpr double kV = 0x1p-24;

// The box of one point: the distance to its farthest corner is that to the point, and the upper
// bound covers what rounds the box.
TEST(BoundValues, FarthestCornerIsBeyondItsDistance) {
  const struct {
    std::array<float, 3> at;
    double distance;
  } rows[] = {{{1, 2, 2}, 3}, {{-2, 3, 6}, 7}, {{0, 0, -0.5f}, 0.5}, {{0, 0, 0}, 0}};
  for (const auto& [at, distance] : rows) {
    const FloatBox box{at, at};
    const double upper = farthest_in_box(box, Point::Zero());
    EXPECT_GT(upper, distance * (1 + 0x1p-42) + 0x1p-40);
    EXPECT_LT(upper, distance * (1 + 0x1p-38) + 0x1p-36);
  }
  const FloatBox box{{-1, 0, 0}, {2, 2, 1}};
  EXPECT_GE(farthest_in_box(box, Point(0, 0, -1)), std::sqrt(4 + 4 + 4.0));
  EXPECT_GE(farthest_in_box(box, Point(1.5, 2, 3)), std::sqrt(6.25 + 4 + 9));
}

// A bound b in float proves (b - sqrt(3) v |p|) / (1 + 16 v), less the error of a value.
TEST(BoundValues, CertifiedIsBelowWhatABoundProves) {
  for (const double at : {0.25, 4.0, 1000.0}) {
    const FloatQuery query = FloatQuery::from(at, -at, at / 2);
    for (const float bound : {0.25f, 3.0f, 4096.0f}) {
      const double proven = (bound - std::sqrt(3) * kV * at) / (1 + 16 * kV) - 0x1p-40;
      EXPECT_LE(certified(query, bound * bound), std::max(0.0, proven));
      EXPECT_GE(certified(query, bound * bound), proven - 32 * kV * bound - 2 * kV * at - 0x1p-37);
      const double reach = std::sqrt(double{prune_threshold(query, bound)});
      EXPECT_GE(reach, bound * (1 + 16 * kV) + std::sqrt(3) * kV * at + 0x1p-40);
    }
  }
}

// A node of one child, about the origin.
Node node_about_origin() {
  Node node{};
  node.child_count = 1;
  node.box = {{-1, -1, -1}, {1, 1, 1}};
  return node;
}

// Squared bound of the first child.
double bound_of(const Node& node, const Point& query, bool discs) {
  namespace kernels = HWY_NAMESPACE;
  const kernels::FloatTag d;
  const auto lane = [&](double value) {
    return hwy::HWY_NAMESPACE::Set(d, static_cast<float>(value));
  };
  const kernels::Wide3 p{lane(query.x()), lane(query.y()), lane(query.z())};
  return double{hwy::HWY_NAMESPACE::GetLane(kernels::child_bounds(node, p, discs, 0))};
}

TEST(BoundValues, BoundsOfBoxesAreTheirDistances) {
  const Node node = node_about_origin();
  EXPECT_EQ(bound_of(node, Point(3, 0, 0), false), 4);
  EXPECT_EQ(bound_of(node, Point(2, -3, 3), false), 9);
  EXPECT_EQ(bound_of(node, Point(0.5, 1, -0.25), false), 0);
}

// D^2 - h^2 errs by 32 v D^2, which the bound must leave out.
TEST(BoundValues, BoundsOfDiscsAreBelowTheirDistances) {
  Node node = node_about_origin();
  node.normal[2][0] = 1;
  node.slab_lower[0] = -0.25f;
  node.slab_upper[0] = 0.25f;
  node.radius[0] = 1;
  // Height 4, and 3 off the axis.
  const double axis_distance = std::sqrt(25 * (1 - 32 * kV) - 16);
  const double most = 3.75 * 3.75 + (axis_distance - 1) * (axis_distance - 1);
  const double bound = bound_of(node, Point(3, 0, 4), true);
  EXPECT_LE(bound, most);
  EXPECT_GE(bound, most * (1 - 32 * kV));
  // Above the disc the planes alone count, beside it the rim alone.
  EXPECT_EQ(bound_of(node, Point(0, 0, 4), true), 3.75 * 3.75);
  EXPECT_LE(bound_of(node, Point(8, 0, 0), true), 49);
  EXPECT_GE(bound_of(node, Point(8, 0, 0), true), 49 * (1 - 48 * kV));
}

}  // namespace
}  // namespace planetree::octree
