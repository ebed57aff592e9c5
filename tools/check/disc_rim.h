#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace planetree::tools {

/// Sides of the prism that stands for the cylinder of a disc.
inline constexpr std::size_t kRimSides = 24;

using RimDirections = std::array<std::array<double, 3>, kRimSides>;

/// Unit vectors across `normal`, which has length 1, in equal steps around it.
[[nodiscard]] inline RimDirections rim_directions(const std::array<double, 3>& normal) {
  // An axis that is not near the normal, less its part along the normal.
  const std::size_t axis = std::fabs(normal[0]) < 0.6 ? 0 : std::fabs(normal[1]) < 0.6 ? 1 : 2;
  std::array<double, 3> first{};
  first[axis] = 1;
  double squared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    first[i] -= normal[axis] * normal[i];
    squared += first[i] * first[i];
  }
  for (double& part : first) part /= std::sqrt(squared);
  const std::array<double, 3> second = {normal[1] * first[2] - normal[2] * first[1],
                                        normal[2] * first[0] - normal[0] * first[2],
                                        normal[0] * first[1] - normal[1] * first[0]};
  // Each step turns by a 24th, so that the same bits come out on every machine.
  constexpr double kCosine = 0.96592582628906831, kSine = 0.25881904510252074;
  RimDirections directions;
  double x = 1, y = 0;
  for (auto& direction : directions) {
    for (std::size_t i = 0; i < 3; ++i) direction[i] = x * first[i] + y * second[i];
    const double turned = x * kCosine - y * kSine;
    y = x * kSine + y * kCosine;
    x = turned;
  }
  return directions;
}

}  // namespace planetree::tools
