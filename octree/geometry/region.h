#pragma once

#include <algorithm>
#include <limits>

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// Where all of a surface is known: of a file that holds what touches a box, that box; without
/// its sides that are not within the model's, for beyond those there is nothing to be known. A
/// side that is left is a wall: what was left out is strictly beyond one. All of space if there
/// is none. Model frame.
class Region {
 public:
  /// All of space.
  Region() = default;
  /// lower, upper          the box, which may be flat,
  /// box_lower, box_upper  and the model's, which has a point in common with it.
  Region(const Point& lower, const Point& upper, const Point& box_lower, const Point& box_upper) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (lower[axis] > box_lower[axis]) lower_[axis] = lower[axis];
      if (upper[axis] < box_upper[axis]) upper_[axis] = upper[axis];
    }
    has_walls_ = lower_.maxCoeff() > -kNone || upper_.minCoeff() < kNone;
  }

  /// Infinite where there is no wall.
  const Point& lower() const { return lower_; }
  const Point& upper() const { return upper_; }

  bool has_walls() const { return has_walls_; }
  /// Whether a point is in it, or on a wall.
  bool holds(const Point& point) const {
    return (point.array() >= lower_.array()).all() && (point.array() <= upper_.array()).all();
  }
  /// Whether it has a point in common with a closed box.
  bool meets(const Point& lower, const Point& upper) const {
    return (upper.array() >= lower_.array()).all() && (lower.array() <= upper_.array()).all();
  }
  /// The nearest point of it.
  Point clamped(const Point& point) const { return point.cwiseMax(lower_).cwiseMin(upper_); }

  /// The distance from a point in it to the nearest wall, rounded; infinite if there is none.
  double gap(const Point& point) const {
    return std::min((point - lower_).minCoeff(), (upper_ - point).minCoeff());
  }
  /// From the point to what was left out it is farther than this, and so it would be found to
  /// be: values of triangles err by some 2^-42 of the distance to a corner (see
  /// BestTriangle), which is no more than theirs and the model's diagonal, below 4. Negative
  /// outside of it and close to a wall.
  double clearance(const Point& point) const {
    if (!holds(point)) return -1;
    const double gap_to_wall = gap(point);
    return gap_to_wall < kNone ? gap_to_wall - 0x1p-40 * (gap_to_wall + 4) : kNone;
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  Point lower_ = Point::Constant(-kNone);
  Point upper_ = Point::Constant(kNone);
  bool has_walls_ = false;  // of these; kept, for every ask wants to know
};

}  // namespace planetree::octree
