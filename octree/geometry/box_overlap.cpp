#include "octree/geometry/box_overlap.h"

#include "octree/geometry/cell_overlap.h"
#include "octree/geometry/predicates.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

// The corner of a box that bit k of a number selects along axis k.
Point box_corner(const Point& lower, const Point& upper, unsigned number) {
  Point corner;
  for (unsigned axis = 0; axis < 3; ++axis)
    corner[axis] = (number >> axis & 1) != 0 ? upper[axis] : lower[axis];
  return corner;
}

// Whether the plane of the triangle has the whole box on one side.
bool is_beyond_plane(const Triangle& triangle, const Point& lower, const Point& upper,
                     WorkLimit& limit) {
  int side = 0;
  for (unsigned number = 0; number < 8; ++number) {
    const int own = orientation(triangle[0], triangle[1], triangle[2],
                                box_corner(lower, upper, number), &limit);
    if (own == 0 || (number > 0 && own != side)) return false;
    side = own;
  }
  return true;
}

// Whether a line along an edge, seen along an axis, has the box on one side and the triangle on the
// other or on the line.
bool is_beyond_edge(const Triangle& triangle, unsigned edge, unsigned axis, const Point& lower,
                    const Point& upper, WorkLimit& limit) {
  const Point &a = triangle[edge], &b = triangle[(edge + 1) % 3], &c = triangle[(edge + 2) % 3];
  const int side = normal_sign(a, b, c, axis, &limit);
  int beyond = 0;
  for (unsigned number = 0; number < 8; ++number) {
    if ((number >> axis & 1) != 0) continue;
    const int own = normal_sign(a, b, box_corner(lower, upper, number), axis, &limit);
    if (own == 0 || own == side || (beyond != 0 && own != beyond)) return false;
    beyond = own;
  }
  return true;
}

}  // namespace

bool touches_box(const Triangle& triangle, const Point& lower, const Point& upper,
                 WorkLimit& limit) {
  if (!may_touch(triangle, lower, upper)) return false;
  for (const Point& corner : triangle)
    if ((corner.array() >= lower.array()).all() && (corner.array() <= upper.array()).all())
      return true;
  if (is_beyond_plane(triangle, lower, upper, limit)) return false;
  for (unsigned axis = 0; axis < 3; ++axis)
    for (unsigned edge = 0; edge < 3; ++edge)
      if (is_beyond_edge(triangle, edge, axis, lower, upper, limit)) return false;
  return true;
}

}  // namespace planetree::octree
