#pragma once

#include <algorithm>
#include <cmath>

#include "octree/geometry/triangle_distance.h"
#include "octree/traversal/bounds.h"

namespace planetree::octree {

/// A segment as float sees it: from `lower` to `upper` along its longest axis, and along each
/// other one within [least, most] of `slope` times how far it has come.
///
/// Errors. With u = 2^-24 and M the largest coordinate of the segment and of what it is held
/// against: slope and offset, each rounded, move the segment by at most 2uM and 2uM; the
/// product errs by uM, and the sum, of at most 3M, by 3uM. [least, most] allows for 8uM and
/// as much again, for its own rounding: nothing that the segment meets is told apart from it,
/// nor what is beside it by the infinitesimal steps of its ends.
struct FloatSegment {
  unsigned axis = 0;
  float lower = 0, upper = 0;
  struct Aside {
    unsigned axis = 0;
    float slope = 0, least = 0, most = 0;
  };
  Aside aside[2];

  /// from, to  relative to `origin` in what is returned.
  /// largest   no coordinate, relative to `origin`, of what it is held against is larger,
  ///           unless `clipped` to [lower, upper] along `axis`.
  static FloatSegment between(const Point& from, const Point& to, const Point& origin,
                              double largest) {
    const Point start = from - origin, end = to - origin, way = to - from;
    FloatSegment segment;
    const Point length = way.cwiseAbs();
    segment.axis = length.x() >= length.y() ? (length.x() >= length.z() ? 0 : 2)
                                            : (length.y() >= length.z() ? 1 : 2);
    const double most = std::max({largest, start.cwiseAbs().maxCoeff(), end.cwiseAbs().maxCoeff()});
    const double slack = 0x1p-20 * most + kAbsoluteSlack;
    const double first = start[segment.axis], last = end[segment.axis];
    segment.lower = static_cast<float>(std::min(first, last) - slack);
    segment.upper = static_cast<float>(std::max(first, last) + slack);
    const double along = way[segment.axis];
    for (unsigned i = 0; i < 2; ++i) {
      Aside& aside = segment.aside[i];
      aside.axis = (segment.axis + 1 + i) % 3;
      aside.slope = along != 0 ? static_cast<float>(way[aside.axis] / along) : 0;
      const double offset = start[aside.axis] - static_cast<double>(aside.slope) * first;
      aside.least = static_cast<float>(offset - slack);
      aside.most = static_cast<float>(offset + slack);
    }
    return segment;
  }
};

}  // namespace planetree::octree
