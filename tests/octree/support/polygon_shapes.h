#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
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

/// A corridor of width 1 that winds outwards in squares, with gaps of width 1 between its turns.
inline FlatPolygon spiral(std::int64_t sides) {
  constexpr std::array<FlatPoint, 4> kWays = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  FlatPolygon outer, inner;
  FlatPoint at = {0, 0};
  for (std::int64_t side = 0; side <= sides; ++side) {
    const FlatPoint& to = kWays[static_cast<std::size_t>(side % 4)];
    const FlatPoint& from = kWays[static_cast<std::size_t>((side + 3) % 4)];
    FlatPoint inside = at;
    if (side < sides) inside = {inside[0] - to[1], inside[1] + to[0]};
    if (side > 0) inside = {inside[0] - from[1], inside[1] + from[0]};
    outer.push_back(at);
    inner.push_back(inside);
    const std::int64_t length = 2 * (side / 2 + 1);
    at = {at[0] + to[0] * length, at[1] + to[1] * length};
  }
  outer.insert(outer.end(), inner.rbegin(), inner.rend());
  return outer;
}

/// A square with rows of square holes. A bridge leads from the left side to the first hole of each
/// row, and from each hole to the next.
inline FlatPolygon keyholes(std::int64_t across) {
  const std::int64_t size = 4 * across;
  FlatPolygon polygon = {{0, 0}, {size, 0}, {size, size}, {0, size}};
  for (std::int64_t row = across; row-- > 0;) {
    const std::int64_t y = 4 * row + 2;
    polygon.push_back({0, y});
    for (std::int64_t i = 0; i < across; ++i) {
      const std::int64_t x = 4 * i + 2;
      polygon.push_back({x - 1, y});
      polygon.push_back({x, y + 1});
      polygon.push_back({x + 1, y});
    }
    for (std::int64_t i = across; i-- > 0;) {
      const std::int64_t x = 4 * i + 2;
      if (i + 1 < across) polygon.push_back({x + 1, y});
      polygon.push_back({x, y - 1});
      polygon.push_back({x - 1, y});
    }
    polygon.push_back({0, y});
  }
  return polygon;
}

/// The outline of unit squares that grow from one another like a tree. Where two of them only lie
/// side by side, the outline runs between them there and back: it is full of slits, of collinear
/// corners and of corners at one place.
///
/// random  () -> std::uint64_t.
template <class Random>
FlatPolygon cell_tree(Random& random, std::size_t cells) {
  FlatPolygon polygon = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  std::set<FlatPoint> taken = {{0, 0}};
  for (std::size_t attempt = 0; attempt < 20 * cells && taken.size() < cells; ++attempt) {
    const std::size_t k = random() % polygon.size();
    const FlatPoint p = polygon[k], q = polygon[(k + 1) % polygon.size()];
    const FlatPoint out = {q[1] - p[1], p[0] - q[0]};
    const FlatPoint r = {p[0] + out[0], p[1] + out[1]}, s = {q[0] + out[0], q[1] + out[1]};
    const FlatPoint cell = {std::min({p[0], q[0], r[0]}), std::min({p[1], q[1], r[1]})};
    if (!taken.insert(cell).second) continue;
    polygon.insert(polygon.begin() + static_cast<std::ptrdiff_t>(k) + 1, {r, s});
  }
  return polygon;
}

/// Whether two closed segments share a point.
inline bool touch(const FlatPoint& a, const FlatPoint& b, const FlatPoint& c, const FlatPoint& d) {
  const auto sign = [](std::int64_t value) { return (value > 0) - (value < 0); };
  for (std::size_t axis = 0; axis < 2; ++axis)
    if (std::max(a[axis], b[axis]) < std::min(c[axis], d[axis]) ||
        std::max(c[axis], d[axis]) < std::min(a[axis], b[axis]))
      return false;
  return sign(area_of(a, b, c)) * sign(area_of(a, b, d)) <= 0 &&
         sign(area_of(c, d, a)) * sign(area_of(c, d, b)) <= 0;
}

/// A random simple polygon of up to `corners` corners with coordinates from 0 to `range`.
template <class Random>
FlatPolygon random_simple(Random& random, std::size_t corners, std::int64_t range) {
  const auto draw = [&] {
    const auto span = static_cast<std::uint64_t>(range + 1);
    const auto x = static_cast<std::int64_t>(random() % span);
    return FlatPoint{x, static_cast<std::int64_t>(random() % span)};
  };
  FlatPolygon polygon = {draw(), draw(), draw()};
  if (area_of(polygon) == 0) polygon = {{0, 0}, {range, 0}, {0, range}};
  for (std::size_t attempt = 0; attempt < 20 * corners && polygon.size() < corners; ++attempt) {
    const std::size_t count = polygon.size(), k = random() % count, after = (k + 1) % count;
    const FlatPoint p = draw();
    bool free = true;
    for (std::size_t i = 0; i < count && free; ++i) {
      const FlatPoint &c = polygon[i], &d = polygon[(i + 1) % count];
      if (i == k) continue;
      const bool is_before = (i + 1) % count == k, is_after = i == after;
      // The neighbours of an edge may share its end, and nothing else.
      if (is_before || is_after) free = area_of(c, d, p) != 0;
      if (free && !is_before) free = !touch(polygon[k], p, c, d);
      if (free && !is_after) free = !touch(p, polygon[after], c, d);
    }
    if (free && area_of(polygon[k], p, polygon[after]) != 0)
      polygon.insert(polygon.begin() + static_cast<std::ptrdiff_t>(k) + 1, p);
  }
  if (area_of(polygon) < 0) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

/// A plane in space: origin + u * along_u + v * along_v.
struct Placement {
  Vec3 origin, along_u, along_v;
};

inline std::vector<Vec3> placed(const FlatPolygon& polygon, const Placement& at) {
  std::vector<Vec3> corners;
  for (const FlatPoint& point : polygon) {
    const auto u = static_cast<double>(point[0]), v = static_cast<double>(point[1]);
    corners.push_back({at.origin.x + u * at.along_u.x + v * at.along_v.x,
                       at.origin.y + u * at.along_u.y + v * at.along_v.y,
                       at.origin.z + u * at.along_u.z + v * at.along_v.z});
  }
  return corners;
}

/// Planes across each axis, tilted ones, and ones with small, large and distant coordinates. All
/// corners of small polygons are exact in them.
inline std::vector<Placement> all_placements() {
  return {{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{1, 2, 3}, {0, 0, 1}, {1, 0, 0}},
          {{0, 0, -5}, {1, 0, 0}, {0, 1, 0}},
          {{0, 0, 0}, {2, 1, -1}, {1, -3, 2}},
          {{7, 7, 7}, {1, 2, 4}, {-3, 1, 1}},
          {{0x1p40, -0x1p41, 3}, {0x1p-8, 0, 0x1p-9}, {0, 0x1p-8, 0x1p-8}},
          {{0, 0, 0}, {0x1p-1060, 0, 0}, {0, 0x1p-1070, 0}},
          {{0, 0, 0}, {0x1p1000, 0, 0x1p1000}, {0, 0x1p1000, 0}}};
}

}  // namespace planetree::octree
