#include "tools/values/colour_scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace planetree::tools {
namespace {

/// The lightness in OKLab (Ottosson 2020), written from its definition.
double lightness(const Colour& colour) {
  double linear[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const double share = colour[i] / 255.0;
    linear[i] = share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
  }
  const auto [r, g, b] = linear;
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return 0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s;
}

TEST(ColourScale, DarkensByEqualStepsOnBothSidesOfZero) {
  const ColourScale scale = ColourScale::diverging(2);
  for (double value = 0; value <= 2; value += 0.05) {
    EXPECT_NEAR(lightness(scale.colour(value)), 0.95 - 0.25 * value, 0.006) << value;
    EXPECT_NEAR(lightness(scale.colour(-value)), 0.95 - 0.25 * value, 0.006) << -value;
  }
  const Colour below = scale.colour(-2), above = scale.colour(2);
  EXPECT_GT(below[2], below[0]) << "blue";
  EXPECT_GT(above[0], above[2]) << "red";
}

TEST(ColourScale, BrightensByEqualStepsWithSizes) {
  const ColourScale scale = ColourScale::sequential(1, 3);
  for (double value = 1; value <= 3; value += 0.05)
    EXPECT_NEAR(lightness(scale.colour(value)), 0.28 + 0.33 * (value - 1), 0.006) << value;
}

TEST(ColourScale, HasColoursForAllValues) {
  const ColourScale scale = ColourScale::diverging(1);
  EXPECT_EQ(scale.colour(7), scale.colour(1));
  EXPECT_EQ(scale.colour(-1e300), scale.colour(-1));
  EXPECT_EQ(scale.colour(std::numeric_limits<double>::quiet_NaN()), ColourScale::kNoValue);
  EXPECT_EQ(scale.colour(std::numeric_limits<double>::infinity()), ColourScale::kNoValue);
  const ColourScale flat = ColourScale::diverging(0);
  EXPECT_EQ(flat.colour(0), scale.colour(0));
  EXPECT_EQ(flat.colour(1), scale.colour(1));
  EXPECT_EQ(css_colour({0, 171, 255}), "#00abff");
}

}  // namespace
}  // namespace planetree::tools
