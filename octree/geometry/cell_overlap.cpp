#include "octree/geometry/cell_overlap.h"

#include <algorithm>
#include <cmath>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

/// The triangle relative to the box's centre, and the half sides of the box. The half sides are
/// slightly enlarged, so that the rounding of the centre does not matter.
struct Centred {
  Triangle corners;
  Point half;
};

Centred centred(const Triangle& triangle, const Point& lower, const Point& upper) {
  const Point centre = (lower + upper) * 0.5;
  Centred result;
  for (unsigned i = 0; i < 3; ++i) result.corners[i] = triangle[i] - centre;
  result.half = (upper - centre).cwiseMax(centre - lower) * (1 + kOverlapMargin);
  return result;
}

/// Returns whether the projections on an axis are apart. The axis has component `p` in direction
/// `i`, `q` in direction `j` and none in the third.
inline bool apart(const Centred& centred, unsigned i, unsigned j, double p, double q) {
  double least = 0, greatest = 0, magnitude = 0;
#pragma GCC unroll 3
  for (unsigned corner = 0; corner < 3; ++corner) {
    const Point& at = centred.corners[corner];
    const double along_i = p * at[i], along_j = q * at[j];
    const double projection = along_i + along_j;
    least = corner == 0 ? projection : std::min(least, projection);
    greatest = corner == 0 ? projection : std::max(greatest, projection);
    magnitude = std::max(magnitude, std::fabs(along_i) + std::fabs(along_j));
  }
  const double reach = std::fabs(p) * centred.half[i] + std::fabs(q) * centred.half[j];
  const double bound = reach + kOverlapMargin * (reach + magnitude) + kProductUnderflow;
  return least > bound || greatest < -bound;
}

bool apart_along_edges(const Centred& centred, const Triangle& triangle) {
  for (unsigned corner = 0; corner < 3; ++corner) {
    const Point edge = triangle[(corner + 1) % 3] - triangle[corner];
#pragma GCC unroll 3
    for (unsigned axis = 0; axis < 3; ++axis) {
      const unsigned i = (axis + 1) % 3, j = (axis + 2) % 3;
      if (apart(centred, i, j, -edge[j], edge[i])) return true;
    }
  }
  return false;
}

bool apart_along_normal(const Centred& centred, const Triangle& triangle) {
  const Point u = triangle[1] - triangle[0], v = triangle[2] - triangle[0];
  const Point& at = centred.corners[0];
  double height = 0, reach = 0, magnitude = 0;
#pragma GCC unroll 3
  for (unsigned axis = 0; axis < 3; ++axis) {
    const unsigned i = (axis + 1) % 3, j = (axis + 2) % 3;
    const double left = u[i] * v[j], right = u[j] * v[i];
    height += (left - right) * at[axis];
    reach += std::fabs(left - right) * centred.half[axis];
    magnitude += (std::fabs(left) + std::fabs(right)) * (std::fabs(at[axis]) + centred.half[axis]);
  }
  return std::fabs(height) > reach + kOverlapMargin * magnitude + kProductUnderflow;
}

}  // namespace

bool may_touch(const Triangle& triangle, const Point& lower, const Point& upper) {
  if ((least_corner(triangle).array() > upper.array()).any() ||
      (greatest_corner(triangle).array() < lower.array()).any())
    return false;
  // Fast path: most triangles that touch a cell have a corner in it.
  for (const Point& corner : triangle)
    if ((corner.array() >= lower.array()).all() && (corner.array() <= upper.array()).all())
      return true;
  const Centred about = centred(triangle, lower, upper);
  return !apart_along_normal(about, triangle) && !apart_along_edges(about, triangle);
}

}  // namespace planetree::octree
