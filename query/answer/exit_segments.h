#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "octree/traversal/tree_view.h"

namespace planetree::query {

/// Returns whether a point of the model frame is strictly outside of a model's box.
inline bool outside_box(const octree::TreeInfo& tree, const octree::Point& point) {
  return (point.array() < tree.box_lower.array()).any() ||
         (point.array() > tree.box_upper.array()).any();
}

/// The six segments along the axes from a point to just outside of a model's box, shortest first.
class ExitSegments {
 public:
  struct Segment {
    double length = 0;
    octree::Point end = octree::Point::Zero();  ///< strictly outside; winding number 0
  };

  /// from  start of all segments: a point in the box, model frame
  ExitSegments(const octree::TreeInfo& tree, const octree::Point& from) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      add(from, axis, tree.box_lower[axis], -1);
      add(from, axis, tree.box_upper[axis], 1);
    }
  }

  const std::array<Segment, 6>& all() const { return segments_; }

 private:
  void add(const octree::Point& from, Eigen::Index axis, double side, double direction) {
    Segment segment{std::fabs(side - from[axis]), from};
    // Adding 1 to a coordinate far from the origin may not change it.
    const double infinity = std::numeric_limits<double>::infinity();
    const double beyond = std::nextafter(side, direction * infinity);
    segment.end[axis] = direction < 0 ? std::min(side - 1, beyond) : std::max(side + 1, beyond);
    // Inserts the segment behind those of the same length.
    std::size_t at = count_++;
    for (; at > 0 && segment.length < segments_[at - 1].length; --at)
      segments_[at] = segments_[at - 1];
    segments_[at] = segment;
  }

  std::size_t count_ = 0;
  std::array<Segment, 6> segments_;
};

}  // namespace planetree::query
