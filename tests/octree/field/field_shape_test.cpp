#include "octree/field/field_shape.h"

#include <gtest/gtest.h>

#include <cmath>

namespace planetree::octree {
namespace {

TEST(FieldShape, CoversTheCoreWithAMargin) {
  const Point lower(-0.7, -0.2, 0.1), upper(0.7, 0.2, 0.1);
  const FieldShape shape = FieldShape::of(lower, upper, 100000);
  const Point end = shape.lower + shape.at(shape.count() - 1);
  EXPECT_TRUE((shape.lower.array() <= lower.array() - 0.174).all());
  EXPECT_TRUE((end.array() >= upper.array() + 0.174).all());
  EXPECT_GE(kMaxFieldCoordinate * shape.quantum, (end - shape.lower).maxCoeff());
}

TEST(FieldShape, TakesHalfAByteATriangleUpToItsLimit) {
  const Point lower(-1, -1, -1), upper(1, 1, 1);
  for (const std::uint64_t triangles : {1024, 5000, 70000, 131072, 600000, 3000000, 20000000}) {
    const FieldShape shape = FieldShape::of(lower, upper, triangles);
    const double allowed = std::max(0.5 * static_cast<double>(triangles),
                                    std::min(0x1p18, 4.0 * static_cast<double>(triangles)));
    EXPECT_LE(static_cast<double>(shape.bytes()), allowed);
    EXPECT_LE(shape.count(), FieldShape::kMaxPoints);
    if (shape.count() < FieldShape::kMaxPoints * 9 / 10) {
      EXPECT_GE(static_cast<double>(shape.bytes()), allowed * 0.6) << triangles;
    }
  }
}

TEST(FieldShape, IsEmptyForSmallModelsAndPoints) {
  EXPECT_EQ(FieldShape::of(Point(-1, -1, -1), Point(1, 1, 1), 1023).count(), 0u);
  EXPECT_EQ(FieldShape::of(Point(1, 1, 1), Point(1, 1, 1), 100000).count(), 0u);
  EXPECT_GT(FieldShape::of(Point(0, 0, 0), Point(0, 0, 1), 100000).count(), 0u);
}

TEST(FieldShape, ThinnedHoldsTheCoreAndFits) {
  const Point lower(-0.7, -0.2, 0.1), upper(0.7, 0.2, 0.6);
  for (const std::uint64_t triangles : {20000, 600000, 20000000}) {
    const FieldShape shape = FieldShape::of(lower, upper, triangles);
    EXPECT_EQ(shape.thinning_for(shape.bytes()), 1u);
    std::uint32_t last = 1;
    for (const double share : {0.9, 0.3, 0.1, 0.01, 0.0}) {
      const auto most = static_cast<std::uint64_t>(share * static_cast<double>(shape.bytes()));
      const std::uint32_t n = shape.thinning_for(most);
      const FieldShape thinned = shape.thinned(n);
      EXPECT_GE(n, last);
      EXPECT_TRUE(thinned.bytes() <= most || 10 * (n + 1) >= shape.size[0]);
      EXPECT_TRUE(n == 1 || shape.thinned(n - 1).bytes() > most);
      const Point end = thinned.lower + thinned.at(thinned.count() - 1);
      EXPECT_TRUE((end.array() >= upper.array()).all()) << n;
      EXPECT_EQ(thinned.at(1, 1, 1), shape.at(n, n, n));
      last = n;
    }
    EXPECT_GT(last, 1u);
  }
}

// Products of steps and quanta with whole numbers are exact, so that every machine agrees.
TEST(FieldShape, HasStepsOfFewBits) {
  for (const std::uint64_t triangles : {2000, 77777, 1234567}) {
    const FieldShape shape = FieldShape::of(Point(0, 0, 0), Point(1.7, 1.1, 0.3), triangles);
    EXPECT_EQ(shape.step, static_cast<double>(static_cast<float>(shape.step)));
    EXPECT_EQ(shape.quantum, static_cast<double>(static_cast<float>(shape.quantum)));
  }
}

}  // namespace
}  // namespace planetree::octree
