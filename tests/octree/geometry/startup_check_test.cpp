#include "octree/geometry/startup_check.h"

#include <gtest/gtest.h>

#include <cfenv>
#include <string_view>

#include <Eigen/Geometry>

#include "octree/geometry/predicates.h"
#include "tests/octree/support/odd_arithmetic.h"

namespace planetree::octree {
namespace {

// Predicates without exact arithmetic: their sign is that of a rounded determinant.
int rounded_orientation(const Point& a, const Point& b, const Point& c, const Point& d) noexcept {
  const double volume = (b - a).cross(c - a).dot(d - a);
  return (volume > 0) - (volume < 0);
}

int rounded_normal_sign(const Point& a, const Point& b, const Point& c, unsigned axis) noexcept {
  const double area = (b - a).cross(c - a)[static_cast<Eigen::Index>(axis)];
  return (area > 0) - (area < 0);
}

TEST(StartupCheck, PassesThisBuild) { EXPECT_EQ(startup_check(), nullptr); }

TEST(StartupCheck, DetectsRoundedPredicates) {
  TestedPredicates wrong = TestedPredicates::library();
  wrong.orientation = &rounded_orientation;
  EXPECT_NE(startup_check(wrong), nullptr);
  wrong = TestedPredicates::library();
  wrong.normal_sign = &rounded_normal_sign;
  EXPECT_NE(startup_check(wrong), nullptr);
}

TEST(StartupCheck, DetectsPredicatesWrongOnUnderflow) {
  TestedPredicates wrong = TestedPredicates::library();
  wrong.orientation = [](const Point& a, const Point& b, const Point& c, const Point& d) noexcept {
    return c.y() > 0 && c.y() < 0x1p-1000 ? 0 : orientation(a, b, c, d);
  };
  EXPECT_NE(startup_check(wrong), nullptr);
}

TEST(StartupCheck, DetectsConstantLiesOn) {
  TestedPredicates wrong = TestedPredicates::library();
  wrong.lies_on = [](const Point&, const Triangle&) noexcept { return false; };
  EXPECT_NE(startup_check(wrong), nullptr);
  wrong.lies_on = [](const Point&, const Triangle&) noexcept { return true; };
  EXPECT_NE(startup_check(wrong), nullptr);
}

// Simulates builds with other arithmetic, as far as the floating-point mode of the thread can.
TEST(StartupCheck, DetectsOtherFloatingPointModes) {
  const auto found = [](int rounding) {
    const OddArithmetic odd(rounding);
    const char* fault = startup_check();
    return std::string_view(fault ? fault : "");
  };
  EXPECT_EQ(found(FE_TONEAREST), "subnormal numbers are taken for zero");
  for (const int rounding : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO})
    EXPECT_EQ(found(rounding), "results are not rounded to nearest, once");
}

}  // namespace
}  // namespace planetree::octree
