#include "octree/builder/job/model_frame.h"

#include <cmath>
#include <cstdlib>

#include "octree/geometry/strict_math.h"

namespace planetree::octree {

// What underflows may become -0, which is another position bit by bit; adding 0 makes it +0.
Point ModelFrame::scaled(const Point& point) const {
  // Within this range the power itself is a double and its product the same as ldexp's.
  constexpr int kMaxPower = 1000;
  if (std::abs(scale_exponent) <= kMaxPower)
    return (point * std::ldexp(1.0, scale_exponent)).array() + 0.0;
  return point.unaryExpr([this](double v) { return std::ldexp(v, scale_exponent) + 0.0; });
}

}  // namespace planetree::octree
