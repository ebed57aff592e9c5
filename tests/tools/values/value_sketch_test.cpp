#include "tools/values/value_sketch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace planetree::tools {
namespace {

double exact_quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  const auto rank =
      static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size()) - 1e-9));
  return values[std::max<std::size_t>(rank, 1) - 1];
}

TEST(ValueSketch, FindsQuantilesWithinItsErrorAtAnyScale) {
  for (const double unit : {1e-30, 1.0, 3e20}) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal(0.1, 1);
    ValueSketch sketch(unit);
    std::vector<double> values, magnitudes;
    for (int i = 0; i < 3000; ++i) {
      values.push_back(unit * 0.01 * std::pow(normal(random), 3));
      magnitudes.push_back(std::fabs(values.back()));
      sketch.add(values.back());
    }
    for (const double share : {0.001, 0.1, 0.45, 0.5, 0.9, 0.95, 0.99, 1.0}) {
      const double exact = exact_quantile(values, share);
      EXPECT_NEAR(sketch.quantile(share), exact,
                  ValueSketch::kRelativeError * std::fabs(exact) + unit * 0x1p-39)
          << share;
      const double magnitude = exact_quantile(magnitudes, share);
      EXPECT_NEAR(sketch.quantile_of_magnitude(share), magnitude,
                  ValueSketch::kRelativeError * magnitude + unit * 0x1p-39)
          << share;
    }
    EXPECT_EQ(sketch.min(), *std::ranges::min_element(values));
    EXPECT_EQ(sketch.max(), *std::ranges::max_element(values));
  }
}

TEST(ValueSketch, TakesValuesBeyondItsBins) {
  ValueSketch sketch(1);
  sketch.add(1e300);
  sketch.add(-1e300);
  sketch.add(1e-300);
  EXPECT_EQ(sketch.quantile(1), 1e300) << "the extremes are exact";
  EXPECT_EQ(sketch.quantile(0), -1e300);
  EXPECT_EQ(sketch.quantile(0.5), 0);
}

TEST(ValueSketch, WeighsValues) {
  ValueSketch sketch(1);
  sketch.add(1, 3);
  sketch.add(2, 1);
  EXPECT_EQ(sketch.weight(), 4);
  EXPECT_NEAR(sketch.quantile(0.75), 1, ValueSketch::kRelativeError);
  EXPECT_NEAR(sketch.quantile(0.76), 2, 2 * ValueSketch::kRelativeError);
}

TEST(ValueSketch, CountsInBinsOfEqualWidth) {
  ValueSketch sketch(10);
  for (int i = 0; i < 1000; ++i) sketch.add(-5 + 0.01 * (i + 0.5));
  const auto histogram = sketch.histogram(-4, 4, 8);
  EXPECT_NEAR(histogram.below, 0.1, 0.002);
  EXPECT_NEAR(histogram.above, 0.1, 0.002);
  double sum = histogram.below + histogram.above;
  for (const double share : histogram.shares) {
    EXPECT_NEAR(share, 0.1, 0.004);
    sum += share;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(ValueSketch, IsZeroWithoutValues) {
  const ValueSketch sketch(1);
  EXPECT_EQ(sketch.quantile(0.5), 0);
  EXPECT_EQ(sketch.quantile_of_magnitude(0.5), 0);
  EXPECT_EQ(sketch.histogram(0, 1, 2).shares, (std::vector<double>{0, 0}));
}

}  // namespace
}  // namespace planetree::tools
