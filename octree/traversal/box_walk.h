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

/// Visits every block whose box meets a given box; see TreeWalk.
class BoxWalk {
 public:
  /// lower, upper  of the given box, model frame
  BoxWalk(const TreeInfo& tree, const Point& lower, const Point& upper, const PageReader& pages,
          TraversalStats& work)
      : box_(rounded_outward(lower, upper, tree.centre)), walk_(tree, pages, work) {}

  /// Starts with those of `subtrees` that meet the box, instead of the root. Starts with the root
  /// if none does.
  void start_from(const NearbySubtrees& subtrees) {
    std::uint64_t meeting = subtrees_meeting(subtrees, box_);
    for (; meeting != 0; meeting &= meeting - 1)
      walk_.start_from(subtrees.link(static_cast<std::size_t>(std::countr_zero(meeting))));
  }

  /// Calls visit(BlockView, link) for each block. Returns false as TreeWalk::run() does.
  template <class Visit>
  bool run(std::uint64_t max_work, const Visit& visit) {
    return run_while(max_work, visit, [] { return true; });
  }
  /// See TreeWalk::run_while().
  template <class Visit, class ShouldContinue>
  bool run_while(std::uint64_t max_work, const Visit& visit,
                 const ShouldContinue& should_continue) {
    return walk_.run_while(
        max_work, visit, [this](const Node& node) { return children_meeting(node, box_); },
        should_continue);
  }

 private:
  /// Converts a box to the form of child boxes: float, relative to the centre, rounded outward.
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
