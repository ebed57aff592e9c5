#include "octree/mask/grid_coordinates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <limits>

#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

TEST(FixedPoint, TruncatesTowardsZero) {
  Noise noise(3);
  for (const unsigned level : {1u, 6u, 18u})
    for (const int scale : {0, 7, -300, 900, -900}) {
      const FixedPoint steps(level, scale);
      const int unit = static_cast<int>(level) - 1 + static_cast<int>(FixedPoint::kBits);
      for (int i = 0; i < 2000; ++i) {
        const double value = std::ldexp(noise.uniform(-1, 1), static_cast<int>(i % 40) - 35);
        const FixedPoint::Digits digits = steps.digits_of(std::ldexp(value, -scale));
        // Exact: a long double has more digits than the value.
        const long double exact = std::ldexp(static_cast<long double>(value), unit);
        ASSERT_EQ(digits.shift < 0, std::fabs(exact) >= 0x1p62L) << value;
        ASSERT_TRUE(digits.shift < 0 || digits.steps() == std::trunc(exact)) << value;
      }
    }
}

TEST(FixedPoint, RefusesValuesOutOfRange) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const FixedPoint steps(6, 0);
  for (const double value : {kInfinity, -kInfinity, std::nan(""), 1e300, -1e300})
    EXPECT_LT(steps.digits_of(value).shift, 0) << value;
  for (const double value : {0.0, 0x1p-1074, 0x1p-100}) {
    EXPECT_EQ(steps.digits_of(value).steps(), 0) << value;
    EXPECT_EQ(steps.digits_of(-value).steps(), 0) << value;
  }
}

}  // namespace
}  // namespace planetree::octree
