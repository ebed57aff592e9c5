#include "octree/winding/winding_number.h"

#include <cmath>

#include <gtest/gtest.h>

#include "octree/geometry/angles.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

// A tree with moments, and the true winding number as a sum over all triangles.
class Winding {
 public:
  explicit Winding(const Soup& soup, std::uint32_t page_bytes = 4096)
      : sample_(build_sample(soup, page_bytes, 0, true)),
        pages_(sample_),
        info_(tree_info(sample_)) {}

  WindingNumber winding(const Point& point, std::uint64_t max_work = ~std::uint64_t{0}) {
    work = TraversalStats();
    return winding_number(info_, point, max_work, pages_.reader(), work);
  }
  double truth(const Point& point) const {
    double sum = 0;
    for (std::uint32_t i = 0; i < sample_.mesh.size(); ++i)
      sum += winding_share(point, sample_.mesh.corners(i)).value;
    return sum;
  }
  SamplePages& pages() { return pages_; }
  const SampleTree& sample() const { return sample_; }
  std::uint64_t records() const { return info_.record_count; }
  TraversalStats work;

 private:
  SampleTree sample_;
  SamplePages pages_;
  TreeInfo info_;
};

Soup bowl(unsigned levels, double rim) {
  Soup soup;
  for (const auto& triangle : sphere(levels))
    if (triangle[0].z + triangle[1].z + triangle[2].z < 3 * rim) soup.push_back(triangle);
  return soup;
}

Point random_point(Noise& noise, double reach) {
  const Vec3 point = noise.point(-reach, reach);
  return {point.x, point.y, point.z};
}

void expect_true(const WindingNumber& found, double truth) {
  EXPECT_LE(std::fabs(found.value - truth), found.error + 1e-12);
  if (found.above_half()) {
    EXPECT_GT(std::fabs(truth), 0.5);
  }
  if (found.below_half()) {
    EXPECT_LT(std::fabs(truth), 0.5);
  }
}

TEST(WindingNumber, MatchesTheSumOverAllTriangles) {
  Noise noise(1);
  const Soup soups[] = {bowl(4, 0.5), height_field(20), scattered(800, 0.3), repeated(100),
                        sphere(3)};
  for (const Soup& soup : soups) {
    Winding winding(soup);
    for (int i = 0; i < 100; ++i) {
      const Point point = random_point(noise, 1.5);
      const WindingNumber found = winding.winding(point);
      expect_true(found, winding.truth(point));
      EXPECT_TRUE(found.complete);
      EXPECT_TRUE(found.above_half() || found.below_half());
    }
  }
}

// At every work limit the interval holds the true number. The sum completes once the comparison
// with 1/2 is certain or all records are visited.
TEST(WindingNumber, ErrorBoundHoldsAtAnyWork) {
  Winding winding(bowl(3, 0.0));
  // On the axis of a bowl whose rim is a great circle the number is one half near the middle, so
  // nearly all records must be visited.
  const Point points[] = {{0.01, 0.005, -0.002}, {0.1, 0.2, -0.4}, {0, 0, 0.3}, {0.4, -0.5, 0.2}};
  for (const Point& point : points) {
    const double truth = winding.truth(point);
    ASSERT_TRUE(winding.winding(point).complete);
    const std::uint64_t needed = winding.work.units;
    for (std::uint64_t units = 0; units <= needed; ++units) {
      const WindingNumber found = winding.winding(point, units);
      expect_true(found, truth);
      EXPECT_LE(winding.work.units, units);
      EXPECT_EQ(found.complete, found.above_half() || found.below_half() || units == needed);
    }
    EXPECT_TRUE(winding.winding(point).complete);
  }
}

// A unit holds the solid angles of eight triangles.
TEST(WindingNumber, ChargesTheTrianglesOfABlock) {
  Noise noise(5);
  Soup soup;
  for (int i = 0; i < 16; ++i)
    soup.push_back({noise.point(-1, 1), noise.point(-1, 1), noise.point(-1, 1)});
  Winding winding(soup);
  EXPECT_TRUE(winding.winding({1.5, 1.5, 2}).complete);
  EXPECT_EQ(winding.work.triangles, 16u);
  EXPECT_EQ(winding.work.blocks, 1u);
  EXPECT_EQ(winding.work.units, 3 * winding.work.nodes + 3);
  EXPECT_FALSE(winding.winding({1.5, 1.5, 2}, winding.work.units - 1).complete);
}

// Where every triangle must be evaluated, the error is that of the triangles alone.
TEST(WindingNumber, IsAccurateWhenAllTrianglesAreEvaluated) {
  // A face of the octahedron is an eighth of the sphere about the origin: 20 faces one way and 16
  // the other sum to one half.
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  Soup half(20, {x, y, z});
  half.insert(half.end(), 16, {z, y, x});
  Winding winding(half);
  const WindingNumber found = winding.winding(Point::Zero());
  EXPECT_NEAR(found.value, 0.5, found.error);
  EXPECT_LT(found.error, 0x1p-38);
  EXPECT_TRUE(found.complete);
  EXPECT_FALSE(found.above_half() || found.below_half());
  EXPECT_EQ(winding.work.nodes + winding.work.blocks, winding.records());
}

TEST(WindingNumber, DetectsPointsOnTheSurface) {
  Winding winding(bowl(3, 0.7));
  for (std::uint32_t i = 0; i < winding.sample().mesh.size(); i += 7) {
    const WindingNumber found = winding.winding(winding.sample().mesh.corners(i)[0]);
    EXPECT_TRUE(found.on_surface);
    EXPECT_TRUE(found.complete);
    EXPECT_GT(found.value, found.error);  // the value is that of the other triangles
  }
}

// Visits few records where the point is far, and a small share of them elsewhere.
TEST(WindingNumber, VisitsFewRecords) {
  Winding winding(sphere(5), 65536);
  Noise noise(2);
  winding.winding({3, 2, 1});
  EXPECT_LE(winding.work.nodes + winding.work.blocks, 2u);
  std::uint64_t sum = 0;
  for (int i = 0; i < 50; ++i) {
    winding.winding(random_point(noise, 1.2));
    sum += winding.work.nodes + winding.work.blocks;
  }
  EXPECT_LT(sum / 50, winding.records() / 10);
}

TEST(WindingNumber, ErrorBoundHoldsWithAMissingPage) {
  Winding winding(bowl(5, 0.8));
  const auto page = static_cast<std::uint32_t>(winding.pages().size() - 1);
  winding.pages().withhold(page);
  Noise noise(4);
  int complete = 0, incomplete = 0;
  for (int i = 0; i < 200; ++i) {
    // Every other point is close to the missing page.
    const WideBlock& block =
        winding.sample().tree.blocks[winding.sample().plan.pages[page].blocks.back()];
    const Triangle lost =
        winding.sample().mesh.corners(winding.sample().keys[block.begin].position);
    const Point point = i % 2 == 0
                            ? random_point(noise, 1.2)
                            : Point((lost[0] + lost[1] + lost[2]) / 3 * noise.uniform(0.99, 1.01));
    const WindingNumber found = winding.winding(point);
    expect_true(found, winding.truth(point));
    EXPECT_EQ(found.complete, found.above_half() || found.below_half());
    complete += found.complete;
    incomplete += !found.complete;
  }
  EXPECT_GT(complete, 80);
  EXPECT_GT(incomplete, 0);
}

// More children are open at once than the list holds: the rest is opened depth first.
TEST(WindingNumber, ErrorBoundHoldsWhenTheOpenListIsFull) {
  Winding winding(scattered(30000, 0.02), 65536);
  ASSERT_GT(winding.records(), 2000u);
  const Point point = winding.sample().mesh.corners(5)[0];
  TraversalStats& work = winding.work;
  // On the surface of a soup the sign is undecided everywhere, so all records are visited.
  const WindingNumber found = winding.winding(point);
  EXPECT_TRUE(found.on_surface);
  EXPECT_LE(work.nodes + work.blocks, winding.records());
  double truth = 0;
  for (std::uint32_t i = 0; i < winding.sample().mesh.size(); ++i)
    truth += winding_share(point, winding.sample().mesh.corners(i)).value;
  EXPECT_LE(std::fabs(found.value - truth), found.error + 1e-12);
}

TEST(WindingNumber, HandlesASingleBlock) {
  Winding winding(height_field(2));
  EXPECT_EQ(winding.records(), 1u);
  const Point point(0.3, 0.4, 0.7);
  expect_true(winding.winding(point), winding.truth(point));
  EXPECT_TRUE(winding.winding(point).complete);
  EXPECT_FALSE(winding.winding(point, 0).complete);
}

}  // namespace
}  // namespace planetree::octree
