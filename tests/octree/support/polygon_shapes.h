#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "planetree/types.h"

/// Polygons in a plane with whole coordinates, counterclockwise, and ways to place them in space.
namespace planetree::octree {

using FlatPoint = std::array<std::int64_t, 2>;
using FlatPolygon = std::vector<FlatPoint>;

/// Twice the area of a triangle; positive if it runs counterclockwise.
inline std::int64_t area_of(const FlatPoint& a, const FlatPoint& b, const FlatPoint& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Twice the area of a polygon.
inline std::int64_t area_of(const FlatPolygon& polygon) {
  std::int64_t sum = 0;
  for (std::size_t k = 2; k < polygon.size(); ++k)
    sum += area_of(polygon[0], polygon[k - 1], polygon[k]);
  return sum;
}

/// A square with a notch from above.
inline FlatPolygon u_shape() {
  return {{0, 0}, {6, 0}, {6, 4}, {4, 4}, {4, 1}, {2, 1}, {2, 4}, {0, 4}};
}

/// A star with four tips; the first corner is reflex.
inline FlatPolygon star() {
  return {{-1, -1}, {0, -8}, {1, -1}, {8, 0}, {1, 1}, {0, 8}, {-1, 1}, {-8, 0}};
}

/// A bar with teeth that point up.
inline FlatPolygon comb(std::int64_t teeth, std::int64_t height) {
  FlatPolygon polygon = {{0, -1}, {2 * teeth, -1}};
  for (std::int64_t t = teeth; t-- > 0;) {
    polygon.push_back({2 * t + 2, 0});
    polygon.push_back({2 * t + 1, height});
  }
  polygon.push_back({0, 0});
  return polygon;
}

/// A corridor of width 1 that winds inwards in squares.
inline FlatPolygon spiral(std::int64_t turns) {
  FlatPolygon outer, inner;
  constexpr std::array<FlatPoint, 4> kCorners = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::int64_t turn = turns; turn > 0; --turn)
    for (const FlatPoint& corner : kCorners) {
      const std::int64_t far = 4 * turn, step = corner[0] < 0 && corner[1] > 0 ? 4 : 0;
      // The last side of each turn ends one corridor further inside.
      outer.push_back({corner[0] * far, corner[1] * (far - 0) - (step - step)});
      inner.push_back({corner[0] * (far - 1), corner[1] * (far - 1)});
    }
  FlatPolygon polygon = outer;
  polygon.insert(polygon.end(), inner.rbegin(), inner.rend());
  return polygon;
}

}  // namespace planetree::octree
