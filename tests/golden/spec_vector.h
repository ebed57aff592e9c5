#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/golden/spec_reader.h"

/// Part of the independent reader: see spec_reader.h.
namespace planetree::golden {

inline SpecPoint operator-(const SpecPoint& a, const SpecPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline SpecPoint cross(const SpecPoint& a, const SpecPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline double dot(const SpecPoint& a, const SpecPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline double length(const SpecPoint& a) { return std::sqrt(dot(a, a)); }

/// The sum of all solid angles over 4 pi.
inline double winding_number(const std::vector<SpecTriangle>& triangles, const SpecPoint& point) {
  double sum = 0;
  for (const SpecTriangle& triangle : triangles) {
    const SpecPoint a = triangle.corners[0] - point, b = triangle.corners[1] - point,
                    c = triangle.corners[2] - point;
    const double al = std::sqrt(dot(a, a)), bl = std::sqrt(dot(b, b)), cl = std::sqrt(dot(c, c));
    sum += 2 * std::atan2(dot(a, cross(b, c)),
                          al * bl * cl + dot(a, b) * cl + dot(b, c) * al + dot(c, a) * bl);
  }
  return sum / (4 * std::numbers::pi);
}

}  // namespace planetree::golden
