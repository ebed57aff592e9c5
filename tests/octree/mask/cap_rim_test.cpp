#include "octree/mask/cap_rim.h"

#include <gtest/gtest.h>

#include <cmath>

#include "octree/geometry/angles.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

class CapRimTest : public testing::Test {
 protected:
  explicit CapRimTest(const Soup& soup = scattered(40, 0.3))
      : sample_(build_sample(soup, 4096, 0, true)), pages_(sample_), info_(tree_info(sample_)) {}

  double share(const Point& point) const {
    double sum = 0;
    for (std::uint32_t i = 0; i < sample_.mesh.size(); ++i)
      sum += winding_share(point, sample_.mesh.corners(i)).value;
    return sum;
  }
  bool may_meet(const Point& lower, const Point& upper) const {
    for (std::size_t cap = 0; cap < rim_.caps(); ++cap)
      if (rim_.may_meet(cap, lower, upper)) return true;
    return false;
  }
  void read() { rim_.read(info_, pages_.reader()); }

  SampleTree sample_;
  SamplePages pages_;
  TreeInfo info_;
  CapRim rim_;
};

TEST_F(CapRimTest, BoundsHowMuchTheShareVariesInABox) {
  read();
  ASSERT_TRUE(rim_.is_known());
  EXPECT_EQ(rim_.caps(), 40u);
  EXPECT_EQ(rim_.edges(), 120u);
  Noise noise(1);
  int free = 0;
  double greatest = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 at = noise.point(-0.2, 1.8);
    const Point lower = info_.core_lower + Point(at.x, at.y, at.z);
    const Point upper = lower + Point::Constant(noise.uniform(0, 0.1));
    if (may_meet(lower, upper)) continue;
    ++free;
    const double variation = rim_.variation(lower, upper), middle = share((lower + upper) * 0.5);
    for (int k = 0; k < 4; ++k) {
      const Vec3 t = noise.point(0, 1);
      const Point point = lower + (upper - lower).cwiseProduct(Point(t.x, t.y, t.z));
      const double difference = std::fabs(share(point) - middle);
      EXPECT_LE(difference, variation + 1e-12);
      greatest = std::max(greatest, difference / variation);
    }
  }
  EXPECT_GT(free, 1000);
  // Edges add up as if all their effects had one direction.
  EXPECT_GT(greatest, 0.05);
}

TEST_F(CapRimTest, LeavesOutEdgesBetweenCaps) {
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{1, 1, 0}, d{0, 1, 0};
  CapRimTest::sample_ = build_sample({{a, b, c}, {a, c, d}}, 4096, 0, true);
  SamplePages pages(sample_);
  CapRim rim;
  rim.read(tree_info(sample_), pages.reader());
  EXPECT_EQ(rim.caps(), 2u);
  EXPECT_EQ(rim.edges(), 4u);
}

TEST_F(CapRimTest, KnowsNothingIfAPageIsMissing) {
  for (std::uint32_t page = 0; page < pages_.size(); ++page) pages_.withhold(page);
  read();
  EXPECT_FALSE(rim_.is_known());
}

TEST(CapRimOfManyCaps, KnowsNothing) {
  const SampleTree sample = build_sample(scattered(CapRim::kMaxCaps + 1, 0.1), 4096, 0, true);
  SamplePages pages(sample);
  CapRim rim;
  rim.read(tree_info(sample), pages.reader());
  EXPECT_FALSE(rim.is_known());
}

}  // namespace
}  // namespace planetree::octree
