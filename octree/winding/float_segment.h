#pragma once

#include <algorithm>
#include <cmath>

#include "octree/geometry/triangle_distance.h"
#include "octree/traversal/bounds.h"

namespace planetree::octree {

/// A segment in float. Along its longest axis it reaches from `lower` to `upper`. Its coordinate on
/// each other axis is `slope` times the coordinate on the longest axis, plus an offset that is
/// known within a range.
///
/// Errors. Let u = 2^-24, and M the greatest coordinate of the segment and of what is tested
/// against it. The rounding of slope and offset moves the segment by at most 2uM each. The product
/// errs by uM. The sum is at most 3M and errs by 3uM. The range of the offset is widened by 8uM for
/// these, and by as much again for its own rounding. So nothing that the segment meets is found
/// apart from it. This includes what it meets only by the infinitesimal steps of its ends.
struct FloatSegment {
  unsigned axis = 0;
  float lower = 0, upper = 0;
  struct CrossAxis {
    unsigned axis = 0;
    float slope = 0, lowest = 0, highest = 0;
  };
  CrossAxis cross_axes[2];

  /// Makes the segment from `from` to `to`, relative to `origin`.
  ///
  /// largest  maximum coordinate, relative to `origin`, of what is tested against the segment.
  ///          What is clipped to [lower, upper] along `axis` may have larger ones.
  static FloatSegment between(const Point& from, const Point& to, const Point& origin,
                              double largest) {
    const Point start = from - origin, end = to - origin, way = to - from;
    FloatSegment segment;
    const Point length = way.cwiseAbs();
    segment.axis = length.x() >= length.y() ? (length.x() >= length.z() ? 0 : 2)
                                            : (length.y() >= length.z() ? 1 : 2);
    const double highest =
        std::max({largest, start.cwiseAbs().maxCoeff(), end.cwiseAbs().maxCoeff()});
    const double slack = 0x1p-20 * highest + kAbsoluteSlack;
    const double first = start[segment.axis], last = end[segment.axis];
    segment.lower = static_cast<float>(std::min(first, last) - slack);
    segment.upper = static_cast<float>(std::max(first, last) + slack);
    const double along = way[segment.axis];
    for (unsigned i = 0; i < 2; ++i) {
      CrossAxis& cross_axes = segment.cross_axes[i];
      cross_axes.axis = (segment.axis + 1 + i) % 3;
      cross_axes.slope = along != 0 ? static_cast<float>(way[cross_axes.axis] / along) : 0;
      const double offset = start[cross_axes.axis] - static_cast<double>(cross_axes.slope) * first;
      cross_axes.lowest = static_cast<float>(offset - slack);
      cross_axes.highest = static_cast<float>(offset + slack);
    }
    return segment;
  }
};

}  // namespace planetree::octree
