#pragma once

#include <boost/multiprecision/cpp_int.hpp>

#include <array>
#include <vector>

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// Whether a closed triangle and a closed box share a point. Clips the triangle by the six sides of
/// the box in rational arithmetic.
inline bool exactly_touches(const Triangle& triangle, const Point& lower, const Point& upper) {
  using Rational = boost::multiprecision::cpp_rational;
  using Corner = std::array<Rational, 3>;
  for (const Point& corner : triangle)
    if ((corner.array() >= lower.array()).all() && (corner.array() <= upper.array()).all())
      return true;
  std::vector<Corner> polygon;
  for (const Point& corner : triangle)
    polygon.push_back({Rational(corner.x()), Rational(corner.y()), Rational(corner.z())});
  for (unsigned side = 0; side < 6 && !polygon.empty(); ++side) {
    const unsigned axis = side / 2;
    const bool least = side % 2 == 0;
    const Rational limit(least ? lower[axis] : upper[axis]);
    // Negative outside of this side of the box.
    const auto depth = [&](const Corner& corner) -> Rational {
      return least ? Rational(corner[axis] - limit) : Rational(limit - corner[axis]);
    };
    std::vector<Corner> clipped;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Corner &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
      const Rational here = depth(from), there = depth(to);
      if (here.sign() >= 0) clipped.push_back(from);
      if (here.sign() * there.sign() >= 0) continue;
      const Rational share = here / (here - there);
      Corner cut;
      for (unsigned k = 0; k < 3; ++k) cut[k] = from[k] + share * (to[k] - from[k]);
      clipped.push_back(cut);
    }
    polygon = std::move(clipped);
  }
  return !polygon.empty();
}

}  // namespace planetree::octree
