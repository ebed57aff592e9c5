#include "tools/shapes/shape_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace planetree::tools {
namespace {

constexpr std::uint64_t kNoiseSeed = 7;

TEST(FractalNoise, IsContinuousAndBounded) {
  const FractalNoise noise(kNoiseSeed, 1.5);
  double least = 0, greatest = 0;
  for (std::uint64_t sample = 0; sample < 5000; ++sample) {
    const auto coordinate = [&](std::uint64_t axis) {
      return 2 * random_unit(kNoiseSeed, 3 * sample + axis) - 1;
    };
    const Vec3 p = {coordinate(0), coordinate(1), coordinate(2)};
    const double here = noise.at(p);
    // The noise has no step between lattice cells, in any octave.
    EXPECT_NEAR(noise.at({p.x + 1e-9, p.y - 1e-9, p.z + 1e-9}), here, 1e-6);
    least = std::min(least, here);
    greatest = std::max(greatest, here);
  }
  EXPECT_GT(least, -FractalNoise::kBound);
  EXPECT_LT(least, -0.5);
  EXPECT_LT(greatest, FractalNoise::kBound);
  EXPECT_GT(greatest, 0.5);
}

TEST(RandomUnit, FillsTheIntervalEvenly) {
  std::array<int, 16> bins{};
  for (std::uint64_t counter = 0; counter < 16'000; ++counter) {
    const double value = random_unit(kNoiseSeed, counter);
    ASSERT_TRUE(value >= 0 && value < 1);
    ++bins[static_cast<std::size_t>(value * 16)];
  }
  for (const int count : bins) EXPECT_NEAR(count, 1000, 150);
  EXPECT_NE(random_unit(1, 0), random_unit(2, 0));
}

}  // namespace
}  // namespace planetree::tools
