#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/nearest/nearest.h"
#include "planetree/types.h"
#include "query/file/scale.h"

namespace planetree::query {

/// Writes the members of an answer that a triangle tells, in model units.
inline void fill_in(const Scale& scale, const octree::NearestAnswer& nearest,
                    ClosestPoint& answer) noexcept {
  answer.distance = scale.out(nearest.distance);
  answer.lower = std::min(scale.out_below(nearest.lower), std::numeric_limits<double>::max());
  answer.upper = scale.out_above(nearest.upper);
  if (!(answer.upper > answer.lower)) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    answer.upper = std::nextafter(answer.lower, kInfinity);
  }
  answer.point = scale.out(nearest.point);
  answer.triangle = nearest.triangle;
  answer.barycentric = {nearest.barycentric[0], nearest.barycentric[1], nearest.barycentric[2]};
  answer.feature = nearest.feature;
  answer.status = nearest.status;
}

}  // namespace planetree::query
