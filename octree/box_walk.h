#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "octree/block_view.h"
#include "octree/bounds.h"
#include "octree/child_bounds.h"
#include "octree/child_tests.h"
#include "octree/tree_view.h"

namespace planetree::octree {

/// Visits every block whose box meets a box, in an order that depends on the
/// tree alone. No allocation, no lock.
class BoxWalk {
 public:
  /// lower, upper  model frame.
  BoxWalk(const TreeFacts& tree, const Point& lower, const Point& upper, PageReader pages,
          TreeWork& work)
      : tree_(tree),
        box_(rounded_outward(lower, upper, tree.centre)),
        work_(work),
        records_(tree, pages) {}

  /// Calls visit(BlockView). False where pages are missing or there was more
  /// than `max_nodes` nodes and blocks to visit: some blocks were not.
  template <class Visit>
  bool run(std::uint64_t max_nodes, const Visit& visit) {
    return run(max_nodes, visit, children_meeting);
  }
  /// The same with another children_meeting(), of those that kernels may have inlined.
  template <class Visit, class Meeting>
  bool run(std::uint64_t max_nodes, const Visit& visit, const Meeting& meeting) {
    // An honest tree cannot be visited longer than it is; a forged one could.
    std::uint64_t left = std::min(max_nodes, tree_.record_count);
    bool complete = true;
    for (push(tree_.root_link, RecordFinder::kNoPage); size_ > 0; --left) {
      if (left == 0) return false;
      const auto [link, from] = links_[--size_];
      const std::byte* record = records_.find(link, work_, from);
      if (!record) {
        complete = false;
      } else if (LinkFormat::is_leaf(link)) {
        ++work_.blocks;
        visit(BlockView(record, tree_.shape));
      } else {
        ++work_.nodes;
        complete = push_children(*reinterpret_cast<const Node*>(record), meeting) && complete;
      }
    }
    return complete;
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

  struct Link {
    std::uint32_t to;
    std::uint32_t from;  // a page
  };
  void push(std::uint32_t to, std::uint32_t from) { links_[size_++] = {to, from}; }

  // A tree deeper than its header may say is forged.
  template <class Meeting>
  bool push_children(const Node& node, const Meeting& meeting) {
    if (size_ + kFanOut > links_.size()) return false;
    unsigned left = meeting(node, box_);
    for (; left != 0; left &= left - 1) {
      const std::uint32_t link = node.link[static_cast<unsigned>(std::countr_zero(left))];
      records_.prefetch(link);
      push(link, records_.page());
    }
    return true;
  }

  const TreeFacts& tree_;
  const FloatBox box_;
  TreeWork& work_;
  RecordFinder records_;
  std::size_t size_ = 0;
  std::array<Link, (kFanOut - 1) * kMaxHeight + 2 * kFanOut> links_;
};

}  // namespace planetree::octree
