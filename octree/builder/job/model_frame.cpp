#include "octree/builder/job/model_frame.h"

#include <cmath>
#include <cstdlib>

#include "octree/geometry/strict_math.h"

namespace planetree::octree {

// Underflow may give -0, whose bits differ from those of +0. Adding 0 makes it +0.
Point ModelFrame::scaled(const Point& point) const {
  // Within this range the power itself is a double, and its product is the same as that of ldexp.
  constexpr int kMaxPower = 1000;
  if (std::abs(scale_exponent) <= kMaxPower)
    return (point * std::ldexp(1.0, scale_exponent)).array() + 0.0;
  return point.unaryExpr([this](double v) { return std::ldexp(v, scale_exponent) + 0.0; });
}

}  // namespace planetree::octree
