#include "octree/builder/mask/octant_overlap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "octree/geometry/cell_overlap.h"
#include "tests/octree/support/each_target.h"
#include "tests/octree/support/triangle_and_box.h"

namespace planetree::octree {
namespace {

using MakePair = TriangleAndBox (*)(Noise&);

/// A triangle and a cell that has the box of a pair as an octant.
struct TriangleAndCell {
  Triangle triangle;
  Point lower, middle, upper;

  TriangleAndCell(const TriangleAndBox& pair, Noise& noise) : triangle(pair.triangle) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      const double from = pair.lower[axis], to = pair.upper[axis];
      const bool above = noise.bits() % 2 == 0;
      lower[axis] = above ? from - (to - from) : from;
      middle[axis] = above ? from : to;
      upper[axis] = above ? to : to + (to - from) * noise.uniform(0, 2);
    }
  }

  void scale(double factor) {
    for (Point& corner : triangle) corner *= factor;
    for (Point* const at : {&lower, &middle, &upper}) *at *= factor;
  }

  unsigned touched() const {
    unsigned touched = 0;
    for (unsigned octant = 0; octant < 8; ++octant) {
      Point from, to;
      for (unsigned axis = 0; axis < 3; ++axis) {
        const bool above = octant >> axis & 1;
        from[axis] = above ? middle[axis] : lower[axis];
        to[axis] = above ? upper[axis] : middle[axis];
      }
      touched |= static_cast<unsigned>(may_touch(triangle, from, to)) << octant;
    }
    return touched;
  }
};

// Compares the overlap of several triangles about one cell with that of each by itself.
void expect_as_one_by_one(MakePair make, int cells) {
  Noise noise(4);
  unsigned some = 0;
  for (int i = 0; i < cells && !testing::Test::HasFailure(); ++i) {
    const TriangleAndCell cell(make(noise), noise);
    OctantOverlap overlap(cell.lower, cell.middle, cell.upper);
    std::vector<unsigned> touched, queried, indices;
    for (unsigned count = noise.bits() % (OctantOverlap::kAtOnce + 1); count > 0; --count) {
      TriangleAndCell other = cell;
      if (!touched.empty()) {
        const double size = (cell.upper - cell.lower).norm();
        const Point way = size * noise.uniform(0, 0.4) * any_point(noise, -1, 1);
        for (Point& corner : other.triangle) corner += way;
      }
      queried.push_back(noise.bits() % 3 == 0 ? noise.bits() % 256 : 255);
      touched.push_back(other.touched() & queried.back());
      some += touched.back() != 0 && touched.back() != 255;
      ASSERT_FALSE(overlap.full());
      overlap.add(other.triangle, queried.back(), 7 * count);
      indices.push_back(7 * count);
    }
    EXPECT_EQ(overlap.full(), touched.size() == OctantOverlap::kAtOnce);
    const OctantOverlap::TouchedOctants certain = overlap.take();
    ASSERT_EQ(certain.count, touched.size());
    for (unsigned k = 0; k < certain.count; ++k) {
      EXPECT_EQ(certain.octants[k], touched[k]);
      EXPECT_EQ(certain.indices[k], indices[k]);
    }
    EXPECT_EQ(overlap.take().count, 0u);
  }
  EXPECT_GT(some, 50u);
}

TEST(OctantOverlap, MatchesTestingEachTriangleByItself) {
  struct OverlapCase {
    const char* name;
    MakePair make;
  };
  for (const OverlapCase& c :
       {OverlapCase{"random", random_pair}, OverlapCase{"needle", needle},
        OverlapCase{"of other size", of_other_size}, OverlapCase{"tiny", tiny},
        OverlapCase{"tiny at a corner", tiny_at_a_corner}, OverlapCase{"on a lattice", on_lattice},
        OverlapCase{"axis-aligned", axis_aligned}, OverlapCase{"barely", barely},
        OverlapCase{"far away", far_away}, OverlapCase{"of few numbers", of_few_numbers}}) {
    SCOPED_TRACE(c.name);
    for (const bool same : on_each_target([&] {
           expect_as_one_by_one(c.make, 400);
           return !testing::Test::HasFailure();
         }))
      EXPECT_TRUE(same);
  }
}

// Triangles of all sizes, so close to the box that float and double may disagree.
TEST(OctantOverlap, MatchesDoubleWhereFloatIsUndecided) {
  Noise noise(8);
  unsigned touching = 0, apart = 0;
  for (int i = 0; i < 60000 && !testing::Test::HasFailure(); ++i) {
    TriangleAndCell cell(barely(noise), noise);
    const double step = std::ldexp(1.0, -10 - static_cast<int>(noise.bits() % 30));
    for (Point& corner : cell.triangle) corner += step * any_point(noise, -1, 1);
    cell.scale(std::ldexp(1.0, static_cast<int>(noise.bits() % 121) - 60));
    OctantOverlap overlap(cell.lower, cell.middle, cell.upper);
    overlap.add(cell.triangle, 255, 0);
    const unsigned touched = cell.touched();
    EXPECT_EQ(overlap.take().octants[0], touched);
    ++(touched != 0 ? touching : apart);
  }
  EXPECT_GT(touching, 9000u);
  EXPECT_GT(apart, 6000u);
}

}  // namespace
}  // namespace planetree::octree
