#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "octree/geometry/child_bounds.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/child_overlap.h"
#include "octree/traversal/nearby_subtrees.h"
#include "octree/traversal/tree_walk.h"

namespace planetree::octree {

/// Visits every block whose box meets a box; see TreeWalk.
class BoxWalk {
 public:
  /// lower, upper  model frame.
  BoxWalk(const TreeInfo& tree, const Point& lower, const Point& upper, const PageReader& pages,
          TraversalStats& work)
      : box_(rounded_outward(lower, upper, tree.centre)), walk_(tree, pages, work) {}

  /// Begins with those of some subtrees that meet the box, where one does, and not with the root.
  void begin_with(const NearbySubtrees& subtrees) {
    std::uint64_t meeting = subtrees_meeting(subtrees, box_);
    for (; meeting != 0; meeting &= meeting - 1)
      walk_.begin_with(subtrees.link(static_cast<std::size_t>(std::countr_zero(meeting))));
  }

  /// Calls visit(BlockView, link). False as TreeWalk's.
  template <class Visit>
  bool run(std::uint64_t max_work, const Visit& visit) {
    return run_while(max_work, visit, [] { return true; });
  }
  /// See TreeWalk.
  template <class Visit, class GoingOn>
  bool run_while(std::uint64_t max_work, const Visit& visit, const GoingOn& going_on) {
    return walk_.run_while(
        max_work, visit, [this](const Node& node) { return children_meeting(node, box_); },
        going_on);
  }

 private:
  /// A box as child boxes are stored: in float, relative to the centre.
  static FloatBox rounded_outward(const Point& lower, const Point& upper, const Point& centre) {
    FloatBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<Eigen::Index>(axis);
      const double least = lower[at] - centre[at], greatest = upper[at] - centre[at];
      const double slack =
          0x1p-23 * std::max(std::fabs(least), std::fabs(greatest)) + kAbsoluteSlack;
      box.lower[axis] = static_cast<float>(least - slack);
      box.upper[axis] = static_cast<float>(greatest + slack);
    }
    return box;
  }

  const FloatBox box_;
  TreeWalk walk_;
};

}  // namespace planetree::octree
