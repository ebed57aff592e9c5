#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/geometry/predicates.h"
#include "planetree/types.h"

namespace planetree::octree {

/// A polygon as seen along an axis. Signs are exact.
class PolygonProjection {
 public:
  /// corners  finite, of magnitude at most 2^301; must outlive this.
  /// axis     0 to 2: the axis to look along.
  PolygonProjection(std::span<const Vec3> corners, unsigned axis)
      : corners_(corners), axis_(axis) {}

  /// Looks from the other side, so that the turns have the other sign.
  void turn_over() { side_ = -side_; }

  [[nodiscard]] std::size_t size() const { return corners_.size(); }
  [[nodiscard]] unsigned axis() const { return axis_; }
  /// Returns 1 if corners a, b, c turn left, -1 if they turn right, 0 if they are collinear.
  [[nodiscard]] int turn(std::size_t a, std::size_t b, std::size_t c) const {
    return side_ * normal_sign(point(a), point(b), point(c), axis_);
  }
  /// Coordinates in the plane of projection.
  [[nodiscard]] double u(std::size_t corner) const {
    return corners_[corner].*kAxes[(axis_ + 1) % 3];
  }
  [[nodiscard]] double v(std::size_t corner) const {
    return corners_[corner].*kAxes[(axis_ + 2) % 3];
  }
  [[nodiscard]] bool is_same(std::size_t a, std::size_t b) const {
    return u(a) == u(b) && v(a) == v(b);
  }
  /// Whether b lies between a and c, and at neither, of three collinear corners.
  [[nodiscard]] bool is_between(std::size_t a, std::size_t b, std::size_t c) const {
    return u(a) != u(c) ? is_in_order(u(a), u(b), u(c)) : is_in_order(v(a), v(b), v(c));
  }

 private:
  static constexpr double Vec3::*kAxes[] = {&Vec3::x, &Vec3::y, &Vec3::z};

  static bool is_in_order(double a, double b, double c) {
    return (a < b && b < c) || (c < b && b < a);
  }
  [[nodiscard]] Point point(std::size_t corner) const {
    return {corners_[corner].x, corners_[corner].y, corners_[corner].z};
  }

  std::span<const Vec3> corners_;
  unsigned axis_;
  int side_ = 1;
};

}  // namespace planetree::octree
