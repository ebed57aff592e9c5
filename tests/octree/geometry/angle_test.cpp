#include "octree/geometry/angles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <Eigen/Geometry>

namespace planetree::octree {
namespace {

double true_angle(const Point& u, const Point& v) {
  using Long = Eigen::Matrix<long double, 3, 1>;
  const Long a = u.cast<long double>(), b = v.cast<long double>();
  return static_cast<double>(std::atan2(a.cross(b).norm(), a.dot(b)));
}

TEST(Angle, IsAccurateForAllDirections) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::uniform_int_distribution<int> exponent(-40, 40);
  for (int i = 0; i < 20000; ++i) {
    const auto direction = [&] {
      const Point p{coordinate(random), coordinate(random), coordinate(random)};
      return Point(p * std::ldexp(1.0, exponent(random)));
    };
    const Point u = direction(), v = direction();
    ASSERT_NEAR(angle_between(u, v), true_angle(u, v), 1e-15);
    ASSERT_EQ(angle_between(u, v), angle_between(v, u));
    ASSERT_EQ(angle_between(u, Point(-u)), 2 * angle_between({1, 0, 0}, {0, 1, 0}));
  }
}

TEST(Angle, IsAccurateFromZeroToPi) {
  for (int i = 0; i <= 4000; ++i) {
    const double angle = i * (3.141592653589793 / 4000);
    const Point u(1, 0, 0), v(std::cos(angle), std::sin(angle), 0);
    ASSERT_NEAR(angle_between(u, v), true_angle(u, v), 1e-15) << i;
  }
}

TEST(Angle, IsIndependentOfVectorLengths) {
  EXPECT_EQ(angle_between({0x1p-300, 0, 0}, {0, 0x1p300, 0}), 0x1.921fb54442d18p+0);
  EXPECT_EQ(angle_between({0x1p-1074, 0, 0}, {0x1p-1074, 0, 0}), 0);
  EXPECT_NEAR(angle_between({1, 0, 0}, {1, 1e-9, 0}), 1e-9, 1e-24);
}

}  // namespace
}  // namespace planetree::octree
