#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "octree/page/block_view.h"
#include "octree/traversal/link_resolver.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// Visits every block that a test of nodes' children lets through, in an order that depends on
/// the tree and the test alone. No allocation, no lock.
class TreeWalk {
 public:
  TreeWalk(const TreeInfo& tree, const PageReader& pages, TraversalStats& work)
      : tree_(tree), work_(work), records_(tree, pages) {}

  /// Begins with this record, and others so named, in place of the root; a list of
  /// NearbySubtrees at most.
  void begin_with(std::uint32_t link) { links_[size_++] = {link, LinkResolver::kNoPage}; }

  /// Calls meeting(Node) for a bit for each child to go to, and visit(BlockView, link). False where
  /// pages are missing or there was more than `max_work` nodes and blocks to visit: some
  /// blocks were not.
  template <class Visit, class Meeting>
  bool run(std::uint64_t max_work, const Visit& visit, const Meeting& meeting) {
    return run_while(max_work, visit, meeting, [] { return true; });
  }

  /// The same for as long as going_on() says so: then false, too.
  template <class Visit, class Meeting, class GoingOn>
  bool run_while(std::uint64_t max_work, const Visit& visit, const Meeting& meeting,
                 const GoingOn& going_on) {
    // An honest tree cannot be visited longer than it is; a forged one could.
    std::uint64_t left = std::min(max_work, tree_.record_count);
    bool complete = true;
    if (size_ == 0) begin_with(tree_.root_link);
    Link next = links_[--size_];
    for (bool more = true; more; --left) {
      if (left == 0 || !going_on()) return false;
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
        // A tree deeper than its header may say is forged.
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
    std::uint32_t from;  // a page
  };

  // Keeps all but the last for later, and asks for them ahead.
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

}  // namespace planetree::octree
