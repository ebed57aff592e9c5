#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "octree/predicates.h"

/// What triangles are to cells' octants and edges.
namespace planetree::octree {

/// As crossing(), but most triangles are told apart by their boxes. Segments run along an
/// axis, from the greater end to the lesser: a triangle no higher than the segment is then
/// below it, such as those in the sides of cells, which take long to tell otherwise.
inline std::int64_t crossing_if_near(const MovedSegment& segment, const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  const Point least = segment.from.cwiseMin(segment.to);
  const Point greatest = segment.from.cwiseMax(segment.to);
  const bool near = (a.cwiseMin(b).cwiseMin(c).array() <= greatest.array()).all() &&
                    (a.cwiseMax(b).cwiseMax(c).array() > least.array()).all();
  return near ? crossing(segment, triangle) : 0;
}

/// Octants about `middle` that the triangle's box touches, one bit each.
inline unsigned octants_of_box(const Triangle& triangle, const Point& middle) {
  constexpr std::array<unsigned, 3> kUpperOctants = {0xaa, 0xcc, 0xf0};
  const auto& [a, b, c] = triangle;
  const Point least = a.cwiseMin(b).cwiseMin(c), greatest = a.cwiseMax(b).cwiseMax(c);
  unsigned octants = 0xff;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const unsigned upper = kUpperOctants[axis];
    if (least[axis] > middle[axis]) octants &= upper;
    if (greatest[axis] < middle[axis]) octants &= ~upper;
  }
  return octants;
}

}  // namespace planetree::octree
