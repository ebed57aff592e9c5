#include <gtest/gtest.h>

#include <bit>
#include <vector>

#include "octree/traversal/overlap.h"
#include "tests/octree/support/each_block.h"
#include "tests/octree/support/each_target.h"
#include "tests/octree/support/sample_mask.h"

namespace planetree::octree {
namespace {

/// A box and its middle, which define eight octants.
struct Halved {
  Point lower, middle, upper;

  Halved grown(double by) const {
    return {lower - Point::Constant(by), middle, upper + Point::Constant(by)};
  }
  // The closed octants, grown by `over` across the middle, that a closed box meets.
  unsigned octants_met(const Point& least, const Point& greatest, double over) const {
    unsigned met = 0;
    for (unsigned octant = 0; octant < 8; ++octant) {
      bool meets = true;
      for (unsigned axis = 0; axis < 3; ++axis) {
        const bool high = (octant >> axis & 1) != 0;
        const double from = high ? middle[axis] - over : lower[axis];
        const double to = high ? upper[axis] : middle[axis] + over;
        meets = meets && least[axis] <= to && greatest[axis] >= from;
      }
      // A box beyond the cell meets none.
      for (unsigned axis = 0; axis < 3; ++axis)
        meets = meets && least[axis] <= upper[axis] && greatest[axis] >= lower[axis];
      met |= static_cast<unsigned>(meets) << octant;
    }
    return met;
  }
};

// Boxes around corners of a mesh, with their middle at the corner or near it, and a few off the
// mesh.
std::vector<Halved> boxes(const SampleMesh& mesh, bool floats) {
  Noise noise(5);
  std::vector<Halved> found;
  for (unsigned i = 0; i < 60; ++i) {
    Point middle = mesh.corners(noise.bits() % mesh.size())[2];
    if (i % 2 == 1) middle += Point::Constant(noise.uniform(-0.03, 0.03));
    Point half = Point::Constant(noise.uniform(0.001, 0.4));
    if (i % 7 == 0) half[i % 3] = 0;
    Halved box{middle - half, middle, middle + half};
    if (floats)
      for (Point* corner : {&box.lower, &box.middle, &box.upper})
        *corner = corner->cast<float>().cast<double>();
    found.push_back(box);
  }
  return found;
}

struct Sets {
  unsigned with_vertex = 0;
  std::vector<unsigned> by_box;
};

// The expected octants, computed from the coordinates without codes.
Sets one_by_one(const BlockView& block, const Halved& box, double over) {
  Sets sets;
  for (unsigned i = 0; i < block.triangle_count(); ++i) {
    const auto [a, b, c] = block.triangle(i);
    sets.by_box.push_back(
        box.octants_met(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c), over));
    for (const Point& corner : {a, b, c}) sets.with_vertex |= box.octants_met(corner, corner, over);
  }
  return sets;
}

// Expects all octants that are met, and none farther than `over`.
void expect_between(const Soup& soup, bool floats, double over) {
  const SampleTree sample = build_sample(soup);
  std::size_t some = 0, all = 0;
  for (const Halved& box : boxes(sample.mesh, floats)) {
    const OctantCodes codes(box.lower, box.middle, box.upper);
    each_block(sample, SamplePages(sample), [&](const BlockView& block, std::uint32_t) {
      const OctantCodes::NearOctants met = codes.near_octants(block);
      const Sets least = one_by_one(block, box, 0);
      const Sets most = one_by_one(block, box.grown(over), over);
      EXPECT_EQ(least.with_vertex & ~met.with_vertex, 0u);
      EXPECT_EQ(met.with_vertex & ~most.with_vertex, 0u);
      for (unsigned i = 0; i < block.triangle_count(); ++i) {
        EXPECT_EQ(least.by_box[i] & ~met.by_box[i], 0u);
        EXPECT_EQ(met.by_box[i] & ~most.by_box[i], 0u);
        const int count = std::popcount(least.by_box[i]);
        some += count > 0 && count < 8;
        all += count == 8;
      }
    });
    ASSERT_FALSE(testing::Test::HasFailure());
  }
  EXPECT_GT(some, 300u);
  EXPECT_GT(all, 20u);
}

TEST(OctantCodes, AreExactWhereSidesAreFloats) {
  expect_between(sphere(4), true, 0);
  expect_between(translated(sphere(3), {3.3f, -7.7f, 0.1f}), true, 0);
}

// Middles at a vertex or between floats, sides between floats.
TEST(OctantCodes, MissNoOctantWhereSidesAreNotFloats) {
  expect_between(sphere(4), false, 0x1p-22);
  expect_between(translated(sphere(3), {3.3f, -7.7f, 0.1f}), false, 0x1p-19);
}

TEST(OctantCodes, AreExactWhereVerticesAreDoubles) {
  const Soup soup = scattered(1500, 0.1);
  ASSERT_TRUE(build_sample(soup).shape.float64);
  expect_between(soup, false, 0);
}

TEST(OctantCodes, AreTheSameOnEveryInstructionSet) {
  const SampleTree sample = build_sample(translated(sphere(4), {0.1f, 0.2f, 0.3f}));
  const SamplePages pages(sample);
  const auto results = on_each_target([&] {
    std::vector<unsigned> bits;
    for (const Halved& box : boxes(sample.mesh, false)) {
      const OctantCodes codes(box.lower, box.middle, box.upper);
      each_block(sample, pages, [&](const BlockView& block, std::uint32_t) {
        const OctantCodes::NearOctants met = codes.near_octants(block);
        bits.push_back(met.with_vertex);
        bits.insert(bits.end(), met.by_box, met.by_box + block.triangle_count());
      });
    }
    return bits;
  });
  ASSERT_FALSE(results.empty());
  for (const auto& bits : results) EXPECT_EQ(bits == results[0], true);
}

}  // namespace
}  // namespace planetree::octree
