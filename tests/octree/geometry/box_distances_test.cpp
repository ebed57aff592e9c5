#include "octree/geometry/box_distances.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/oracle/random.h"

namespace planetree::octree {
namespace {

constexpr double kLargest = std::numeric_limits<double>::max();

class BoxDistances : public testing::Test {
 protected:
  void add(const Box& box) {
    const double corners[] = {box.lower.x, box.lower.y, box.lower.z,
                              box.upper.x, box.upper.y, box.upper.z};
    for (std::size_t i = 0; i < 6; ++i) columns_[i].push_back(corners[i]);
  }
  std::vector<double> squared(const Vec3& point) {
    BoxColumns columns;
    for (std::size_t i = 0; i < 6; ++i) columns[i] = columns_[i];
    std::vector<double> found(columns_[0].size());
    squared_box_distances(columns, point, found);
    return found;
  }

  std::vector<double> columns_[6];
};

TEST_F(BoxDistances, AreThoseToTheNearestPoint) {
  oracle::Random random(1);
  std::vector<Box> boxes;
  for (int i = 0; i < 37; ++i) {
    const Vec3 a = random.in_cube(), b = random.in_cube();
    boxes.push_back({{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
                     {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}});
    add(boxes.back());
  }
  std::size_t within = 0;
  for (int k = 0; k < 100; ++k) {
    const Vec3 point = random.in_cube();
    const std::vector<double> found = squared(point);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const auto [lower, upper] = boxes[i];
      const long double x = std::clamp(point.x, lower.x, upper.x) -
                            static_cast<long double>(point.x),
                        y = std::clamp(point.y, lower.y, upper.y) -
                            static_cast<long double>(point.y),
                        z = std::clamp(point.z, lower.z, upper.z) -
                            static_cast<long double>(point.z);
      const long double truth = x * x + y * y + z * z;
      EXPECT_LE(std::fabs(found[i] - truth), truth * 0x1p-50L);
      within += truth == 0;
    }
    EXPECT_EQ(least_value(found), *std::min_element(found.begin(), found.end()));
  }
  EXPECT_GT(within, 50u);
}

TEST_F(BoxDistances, AreFiniteHoweverFarTheBoxIs) {
  add({{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()},
       {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
        std::numeric_limits<double>::infinity()}});
  add({{kLargest, 0, 0}, {kLargest, 1, 1}});
  add({{1e200, 0, 0}, {1e201, 1, 1}});
  EXPECT_EQ(squared({-kLargest, 0, 0}), (std::vector<double>{0, kLargest, kLargest}));
  EXPECT_EQ(least_value({}), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace planetree::octree
