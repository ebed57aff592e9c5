#pragma once

#include <cmath>
#include <limits>

#include "octree/geometry/triangle_distance.h"
#include "planetree/types.h"

namespace planetree::query {

/// Converts between model units, which are the input's, and the model frame, which is the input
/// times 2^exponent. Exact except for results below 2^-1022.
class Scale {
 public:
  explicit Scale(int exponent)
      : in_{std::ldexp(1.0, exponent / 2), std::ldexp(1.0, exponent - exponent / 2)},
        out_{std::ldexp(1.0, -(exponent / 2)), std::ldexp(1.0, exponent / 2 - exponent)},
        exponent_(exponent) {}

  int exponent() const { return exponent_; }

  /// Converts to the model frame (`in`) or to model units (`out`).
  double in(double length) const { return length * in_[0] * in_[1]; }
  double out(double length) const { return length * out_[0] * out_[1]; }
  octree::Point in(const Vec3& point) const { return {in(point.x), in(point.y), in(point.z)}; }
  Vec3 out(const octree::Point& point) const {
    return {out(point.x()), out(point.y()), out(point.z())};
  }

  /// Convert a bound to model units. A subnormal result is rounded down or up, so that it stays a
  /// bound.
  double out_below(double length) const {
    const double value = out(length);
    return value < std::numeric_limits<double>::min() ? std::max(0.0, std::nextafter(value, 0.0))
                                                      : value;
  }
  double out_above(double length) const {
    const double value = out(length);
    return value < std::numeric_limits<double>::min()
               ? std::nextafter(value, std::numeric_limits<double>::infinity())
               : value;
  }

 private:
  // Two factors, because 2^exponent may be outside of the range of double.
  double in_[2];
  double out_[2];
  int exponent_;
};

}  // namespace planetree::query
