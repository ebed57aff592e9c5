#include "octree/mask/cap_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "octree/geometry/angles.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

/// Small triangles at one corner of the unit cube, and one far away that sets the scale.
Soup caps_in_a_corner() {
  Soup soup = scattered(60, 0.05, 3);
  for (auto& triangle : soup)
    for (Vec3& corner : triangle) corner = {corner.x / 8, corner.y / 8, corner.z / 8};
  soup.push_back({Vec3{1, 1, 1}, Vec3{0.99, 1, 1}, Vec3{1, 0.99, 1}});
  return soup;
}

class CapGridTest : public testing::Test {
 protected:
  explicit CapGridTest(const Soup& soup = caps_in_a_corner())
      : sample_(build_sample(soup, 4096, 0, true)),
        pages_(sample_),
        info_(tree_info(sample_)),
        memory_(CapGrid::kBytes / sizeof(std::uint64_t)) {}

  void fill() {
    reader_ = pages_.reader();
    grid_.fill(info_, 1 << 20, info_.core_lower, reader_,
               std::as_writable_bytes(std::span(memory_)));
  }

  double share(const Point& point) const {
    double sum = 0;
    for (std::uint32_t i = 0; i < sample_.mesh.size(); ++i)
      sum += winding_share(point, sample_.mesh.corners(i)).value;
    return sum;
  }
  Point random_point(Noise& noise) const {
    const Vec3 p = noise.point(-0.05, 2.05);
    return info_.core_lower + Point(p.x, p.y, p.z);
  }

  SampleTree sample_;
  SamplePages pages_;
  TreeInfo info_;
  PageReader reader_;
  std::vector<std::uint64_t> memory_;
  CapGrid grid_;
};

TEST_F(CapGridTest, IsClearEverywhereWithoutCaps) {
  EXPECT_TRUE(CapGrid().is_clear(Point(1e9, 0, 0)));
  EXPECT_TRUE(CapGrid().is_clear_between(Point(-9, 0, 0), Point(9, 9, 9)));
}

TEST_F(CapGridTest, IsClearNowhereBeforeItIsFilled) {
  EXPECT_FALSE(CapGrid::unfilled().is_clear(Point(1e9, 0, 0)));
  EXPECT_FALSE(CapGrid::unfilled().is_clear_box(Point(0, 0, 0), Point(0, 0, 0)));
}

TEST_F(CapGridTest, CapsHaveShareBelowOneHalfWhereItIsClear) {
  fill();
  Noise noise(1);
  int clear = 0, outside = 0;
  for (int i = 0; i < 4000; ++i) {
    const Point point = random_point(noise);
    const bool in_cube = (point - info_.core_lower).minCoeff() > -0x1p-5 &&
                         (point - info_.core_lower).maxCoeff() < 2 + 0x1p-5;
    outside += !in_cube;
    if (!grid_.is_clear(point)) continue;
    ++clear;
    EXPECT_TRUE(in_cube);
    EXPECT_LT(std::fabs(share(point)), 0.49);
  }
  EXPECT_GT(clear, 3000);
  EXPECT_GT(outside, 50);
}

TEST_F(CapGridTest, IsNotClearAtCaps) {
  fill();
  for (std::uint32_t i = 0; i < sample_.mesh.size(); ++i) {
    const Triangle cap = sample_.mesh.corners(i);
    EXPECT_FALSE(grid_.is_clear(cap[0]));
    EXPECT_FALSE(grid_.is_clear((cap[0] + cap[1] + cap[2]) / 3));
    const Point way = 0.03 * Point(1, 1, 1);
    EXPECT_FALSE(grid_.is_clear_between(cap[1] - way, cap[1] + way));
  }
}

// A box or a segment is clear only if all cells on the way are.
TEST_F(CapGridTest, IsClearBetweenPointsIfAllCellsAre) {
  fill();
  Noise noise(2);
  int clear = 0;
  for (int i = 0; i < 2000; ++i) {
    const Point from = random_point(noise);
    const Vec3 step = noise.point(-0.05, 0.05);
    const Point to = from + Point(step.x, step.y, step.z);
    if (!grid_.is_clear_between(from, to)) continue;
    ++clear;
    EXPECT_TRUE(grid_.is_clear_box(from.cwiseMin(to), from.cwiseMax(to)));
    for (const double at : {0.0, 0.3, 0.7, 1.0})
      EXPECT_TRUE(grid_.is_clear(Point(from + at * (to - from))));
  }
  EXPECT_GT(clear, 500);
  EXPECT_FALSE(grid_.is_clear_between(info_.core_lower, info_.core_lower + Point(2, 2, 2)));
}

TEST_F(CapGridTest, IsNotClearWherePagesAreMissing) {
  for (std::uint32_t page = 0; page < pages_.size(); ++page) pages_.withhold(page);
  fill();
  Noise noise(3);
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(grid_.is_clear(random_point(noise)));
}

}  // namespace
}  // namespace planetree::octree
