#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "octree/page/block_view.h"
#include "octree/traversal/link_resolver.h"
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
  /// visit. Returns false if some blocks were not visited, because pages were not available or more
  /// than `max_work` nodes and blocks would have been visited.
  template <class Visit, class Meeting>
  bool run(std::uint64_t max_work, const Visit& visit, const Meeting& meeting) {
    return run_while(max_work, visit, meeting, [] { return true; });
  }

  /// Same as run(), but also returns false as soon as should_continue() does.
  template <class Visit, class Meeting, class ShouldContinue>
  bool run_while(std::uint64_t max_work, const Visit& visit, const Meeting& meeting,
                 const ShouldContinue& should_continue) {
    // A valid tree takes at most record_count visits; a corrupt one may take more.
    std::uint64_t left = std::min(max_work, tree_.record_count);
    bool complete = true;
    if (size_ == 0) start_from(tree_.root_link);
    Link next = links_[--size_];
    for (bool more = true; more; --left) {
      if (left == 0 || !should_continue()) return false;
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

}  // namespace planetree::octree
