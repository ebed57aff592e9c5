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

/// More caps than a CapRim reads.
Soup many_caps_in_a_corner() {
  Soup soup = caps_in_a_corner();
  for (std::uint64_t seed = 4; seed < 24; ++seed)
    for (auto triangle : scattered(60, 0.05, seed)) {
      for (Vec3& corner : triangle) corner = {corner.x / 8, corner.y / 8, corner.z / 8};
      soup.push_back(triangle);
    }
  return soup;
}

/// A disc of radius 1/2 about (1/2, 1/2, 0), which closes a round hole.
Soup disc(int corners) {
  const auto at = [corners](int i) {
    const double angle = 2 * 3.14159265358979323846 * (i % corners) / corners;
    return Vec3{0.5 + 0.5 * std::cos(angle), 0.5 + 0.5 * std::sin(angle), 0};
  };
  Soup soup;
  for (int i = 0; i < corners; ++i) soup.push_back({Vec3{0.5, 0.5, 0}, at(i), at(i + 1)});
  return soup;
}

/// Caps, and the grid that is filled from their tree.
class Caps {
 public:
  explicit Caps(const Soup& soup)
      : sample_(build_sample(soup, 4096, 0, true)),
        pages_(sample_),
        info_(tree_info(sample_)),
        surface_(info_),
        memory_(CapGrid::kBytes / sizeof(std::uint64_t)) {
    surface_.record_count = 1 << 20;
  }

  void fill() {
    reader_ = pages_.reader();
    grid_.fill(info_, surface_, reader_, std::as_writable_bytes(std::span(memory_)));
  }
  const CapGrid& grid() const { return grid_; }
  SamplePages& pages() { return pages_; }
  std::uint32_t count() const { return sample_.mesh.size(); }
  Triangle cap(std::uint32_t i) const { return sample_.mesh.corners(i); }

  double share(const Point& point) const {
    double sum = 0;
    for (std::uint32_t i = 0; i < count(); ++i) sum += winding_share(point, cap(i)).value;
    return sum;
  }
  Point middle() const { return (info_.core_lower + info_.core_upper) * 0.5; }
  double edge() const { return (info_.core_upper - info_.core_lower).maxCoeff(); }
  Point random_point(Noise& noise) const {
    const Vec3 p = noise.point(-0.65, 0.65);
    return middle() + edge() * Point(p.x, p.y, p.z);
  }

 private:
  SampleTree sample_;
  SamplePages pages_;
  TreeInfo info_, surface_;
  PageReader reader_;
  std::vector<std::uint64_t> memory_;
  CapGrid grid_;
};

class CapGridTest : public testing::TestWithParam<Soup (*)()> {};

INSTANTIATE_TEST_SUITE_P(Caps, CapGridTest,
                         testing::Values(caps_in_a_corner, many_caps_in_a_corner));

TEST(CapGridWithoutCaps, IsClearEverywhere) {
  EXPECT_TRUE(CapGrid().is_clear(Point(1e9, 0, 0)));
  EXPECT_TRUE(CapGrid().is_clear_between(Point(-9, 0, 0), Point(9, 9, 9)));
}

TEST(CapGridWithoutCaps, IsClearNowhereBeforeItIsFilled) {
  EXPECT_FALSE(CapGrid::unfilled().is_clear(Point(1e9, 0, 0)));
  EXPECT_FALSE(CapGrid::unfilled().is_clear_box(Point(0, 0, 0), Point(0, 0, 0)));
}

TEST_P(CapGridTest, CapsHaveShareBelowOneHalfWhereItIsClear) {
  Caps caps(GetParam()());
  caps.fill();
  Noise noise(1);
  int clear = 0, outside = 0;
  for (int i = 0; i < 4000; ++i) {
    const Point point = caps.random_point(noise);
    const bool in_cube =
        (point - caps.middle()).cwiseAbs().maxCoeff() < (0.625 + 1e-9) * caps.edge();
    outside += !in_cube;
    if (!caps.grid().is_clear(point)) continue;
    ++clear;
    EXPECT_TRUE(in_cube);
    EXPECT_LT(std::fabs(caps.share(point)), 0.49);
  }
  EXPECT_GT(clear, 3000);
  EXPECT_GT(outside, 50);
}

TEST_P(CapGridTest, IsNotClearAtCaps) {
  Caps caps(GetParam()());
  caps.fill();
  for (std::uint32_t i = 0; i < caps.count(); ++i) {
    const Triangle cap = caps.cap(i);
    EXPECT_FALSE(caps.grid().is_clear(cap[0]));
    EXPECT_FALSE(caps.grid().is_clear((cap[0] + cap[1] + cap[2]) / 3));
    const Point way = 0.03 * Point(1, 1, 1);
    EXPECT_FALSE(caps.grid().is_clear_between(cap[1] - way, cap[1] + way));
  }
}

// A box or a segment is clear only if all cells on the way are.
TEST_P(CapGridTest, IsClearBetweenPointsIfAllCellsAre) {
  Caps caps(GetParam()());
  caps.fill();
  Noise noise(2);
  int clear = 0;
  for (int i = 0; i < 2000; ++i) {
    const Point from = caps.random_point(noise);
    const Vec3 step = noise.point(-0.03, 0.03);
    const Point to = from + Point(step.x, step.y, step.z);
    if (!caps.grid().is_clear_between(from, to)) continue;
    ++clear;
    EXPECT_TRUE(caps.grid().is_clear_box(from.cwiseMin(to), from.cwiseMax(to)));
    for (const double at : {0.0, 0.3, 0.7, 1.0})
      EXPECT_TRUE(caps.grid().is_clear(Point(from + at * (to - from))));
  }
  EXPECT_GT(clear, 500);
  const Point reach = Point::Constant(0.6 * caps.edge());
  EXPECT_FALSE(caps.grid().is_clear_between(caps.middle() - reach, caps.middle() + reach));
}

TEST_P(CapGridTest, IsNotClearWherePagesAreMissing) {
  Caps caps(GetParam()());
  for (std::uint32_t page = 0; page < caps.pages().size(); ++page) caps.pages().withhold(page);
  caps.fill();
  Noise noise(3);
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(caps.grid().is_clear(caps.random_point(noise)));
}

// The share on the axis of a round hole of radius R is (1 - h / sqrt(h^2 + R^2)) / 2 at a height h.
TEST(CapGridAtAHole, IsClearBesideThePlaneOfTheHole) {
  Caps caps(disc(200));
  caps.fill();
  for (const double height : {0.1, 0.2, 0.4}) {
    const Point above(0, 0, height * caps.edge());
    EXPECT_TRUE(caps.grid().is_clear(Point(caps.middle() + above)));
    EXPECT_TRUE(caps.grid().is_clear(Point(caps.middle() - above)));
  }
  EXPECT_FALSE(caps.grid().is_clear(caps.middle()));
}

}  // namespace
}  // namespace planetree::octree
