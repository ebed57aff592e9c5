#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "octree/geometry/child_bounds.h"
#include "octree/geometry/error_bounds.h"
#include "octree/geometry/work_limit.h"
#include "octree/page/frame.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/link_resolver.h"
#include "octree/traversal/nearby_lists.h"
#include "octree/traversal/overlap.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// Visits every block that a test of nodes' children selects. The order of visits depends only on
/// the tree and the test. No allocation, no lock.
class TreeWalk {
 public:
  TreeWalk(const TreeInfo& tree, const PageReader& pages, TraversalStats& work)
      : tree_(tree), work_(work), records_(tree, pages) {}

  /// Starts with this record instead of the root. May be called for each link of a NearbySubtrees.
  void start_from(std::uint32_t link) { links_[size_++] = {link, LinkResolver::kNoPage}; }

  /// Calls visit(BlockView, link) for each block. meeting(Node) returns a bit for each child to
  /// visit. Returns false if some blocks were not visited, because pages were not available or the
  /// work would have exceeded `max_work`. A visit is one unit; what visit() does more it charges
  /// itself.
  template <class Visit, class Meeting>
  bool run(std::uint64_t max_work, const Visit& visit, const Meeting& meeting) {
    return run_while(max_work, visit, meeting, [] { return true; });
  }

  /// Same as run(), but also returns false as soon as should_continue() does.
  template <class Visit, class Meeting, class ShouldContinue>
  bool run_while(std::uint64_t max_work, const Visit& visit, const Meeting& meeting,
                 const ShouldContinue& should_continue) {
    // A valid tree takes at most record_count visits; a corrupt one may take more.
    std::uint64_t left = tree_.record_count;
    WorkLimit limit(work_.units, max_work);
    bool complete = true;
    if (size_ == 0) start_from(tree_.root_link);
    Link next = links_[--size_];
    for (bool more = true; more; --left) {
      if (left == 0 || !should_continue() || !limit.take()) return false;
      const std::byte* record = records_.find(next.to, work_, next.from);
      unsigned children = 0;
      if (!record) {
        complete = false;
      } else if (LinkFormat::is_leaf(next.to)) {
        ++work_.blocks;
        visit(BlockView(record, tree_.shape), next.to);
      } else {
        ++work_.nodes;
        const Node& node = *reinterpret_cast<const Node*>(record);
        // Only a corrupt tree is deeper than the format allows.
        const bool fits = size_ + kFanOut <= links_.size();
        complete = fits && complete;
        children = fits ? meeting(node) : 0;
        if (children != 0) next = last_of(node, children);
      }
      more = children != 0 || size_ > 0;
      if (children == 0 && more) next = links_[--size_];
    }
    return complete;
  }

 private:
  struct Link {
    std::uint32_t to;
    std::uint32_t from;  // page of the parent
  };

  // Returns the last child; pushes the others and prefetches them.
  Link last_of(const Node& node, unsigned children) {
    const std::uint32_t page = records_.page();
    for (; (children & (children - 1)) != 0; children &= children - 1) {
      const std::uint32_t link = node.link[static_cast<unsigned>(std::countr_zero(children))];
      records_.prefetch(link);
      links_[size_++] = {link, page};
    }
    return {node.link[static_cast<unsigned>(std::countr_zero(children))], page};
  }

  const TreeInfo& tree_;
  TraversalStats& work_;
  LinkResolver records_;
  std::size_t size_ = 0;
  std::array<Link, (kFanOut - 1) * kMaxHeight + 2 * kFanOut> links_;
};

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
          kBoxRounding * std::max(std::fabs(least), std::fabs(greatest)) + kAbsoluteBoundSlack;
      box.lower[axis] = static_cast<float>(least - slack);
      box.upper[axis] = static_cast<float>(greatest + slack);
    }
    return box;
  }

  const FloatBox box_;
  TreeWalk walk_;
};

}  // namespace planetree::octree
