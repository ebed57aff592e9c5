#pragma once

#include <algorithm>
#include <limits>

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// The box within which the whole surface is known, in the model frame.
///
/// A file may hold only the triangles that touch a given box. A side of that box within the model's
/// box is a wall. The other sides are dropped, since no triangle lies beyond the model's box: the
/// region is unbounded there. Every triangle that the file lacks lies strictly beyond a wall. The
/// region of a complete file is all of space.
class Region {
 public:
  /// All of space.
  Region() = default;
  /// lower, upper          the given box, which may be flat
  /// box_lower, box_upper  the model's box; has a point in common with the given box
  Region(const Point& lower, const Point& upper, const Point& box_lower, const Point& box_upper) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (lower[axis] > box_lower[axis]) lower_[axis] = lower[axis];
      if (upper[axis] < box_upper[axis]) upper_[axis] = upper[axis];
    }
    has_walls_ = lower_.maxCoeff() > -kNone || upper_.minCoeff() < kNone;
  }

  /// Lower walls; -infinity on an axis without one. upper() is infinity there.
  const Point& lower() const { return lower_; }
  const Point& upper() const { return upper_; }

  bool has_walls() const { return has_walls_; }
  /// Returns whether a point is in the region or on a wall.
  bool holds(const Point& point) const {
    return (point.array() >= lower_.array()).all() && (point.array() <= upper_.array()).all();
  }
  /// Returns whether the region has a point in common with a closed box.
  bool meets(const Point& lower, const Point& upper) const {
    return (upper.array() >= lower_.array()).all() && (lower.array() <= upper_.array()).all();
  }
  /// Returns the nearest point of the region.
  Point clamped(const Point& point) const { return point.cwiseMax(lower_).cwiseMin(upper_); }

  /// Returns the distance from a point of the region to the nearest wall, rounded; infinity if
  /// there is no wall.
  double gap(const Point& point) const {
    return std::min((point - lower_).minCoeff(), (upper_ - point).minCoeff());
  }
  /// Returns a distance that all missing triangles exceed, also as evaluated. A triangle's value
  /// errs by about 2^-42 of the distance to its farthest corner (see BestTriangle). That distance
  /// is at most the triangle's own distance plus the model's diagonal, which is below 4. The result
  /// is negative outside of the region and close to a wall, and infinity without walls.
  double clearance(const Point& point) const {
    if (!holds(point)) return -1;
    const double gap_to_wall = gap(point);
    return gap_to_wall < kNone ? gap_to_wall - 0x1p-40 * (gap_to_wall + 4) : kNone;
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  Point lower_ = Point::Constant(-kNone);
  Point upper_ = Point::Constant(kNone);
  bool has_walls_ = false;  // derived from the above; cached because every query reads it
};

}  // namespace planetree::octree
