#include "octree/crossings.h"

#include <algorithm>
#include <array>
#include <bit>

#include "octree/block_view.h"
#include "octree/bounds.h"
#include "octree/child_bounds.h"
#include "octree/strict_math.h"

namespace planetree::octree {
namespace {

/// The box of a segment, rounded outward to what child boxes are stored in.
FloatBox box_of(const Point& lower, const Point& upper, const Point& centre) {
  FloatBox box;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double least = lower[axis] - centre[axis], greatest = upper[axis] - centre[axis];
    const double slack = 0x1p-23 * std::max(std::fabs(least), std::fabs(greatest)) + kAbsoluteSlack;
    const auto at = static_cast<std::size_t>(axis);
    box.lower[at] = static_cast<float>(least - slack);
    box.upper[at] = static_cast<float>(greatest + slack);
  }
  return box;
}

class Walk {
 public:
  Walk(const TreeFacts& tree, const MovedSegment& segment, PageReader pages, TreeWork& work)
      : tree_(tree),
        segment_(segment),
        lower_(segment.from.cwiseMin(segment.to)),
        upper_(segment.from.cwiseMax(segment.to)),
        box_(box_of(lower_, upper_, tree.centre)),
        work_(work),
        records_(tree, pages) {}

  Crossings run(std::uint64_t max_nodes) {
    // An honest tree cannot be visited longer than it is; a forged one could.
    std::uint64_t left = std::min(max_nodes, tree_.record_count);
    push(tree_.root_link);
    while (size_ > 0 && count_.complete && !count_.on_surface) {
      count_.complete = left-- > 0;
      if (count_.complete) visit(links_[--size_]);
    }
    return count_;
  }

 private:
  void push(std::uint32_t link) { links_[size_++] = link; }

  void visit(std::uint32_t link) {
    const std::byte* record = records_.find(link, work_);
    if (!record) {
      count_.complete = false;
    } else if (LinkFormat::is_leaf(link)) {
      ++work_.blocks;
      visit_block(BlockView(record, tree_.shape));
    } else {
      ++work_.nodes;
      visit_node(*reinterpret_cast<const Node*>(record));
    }
  }

  void visit_node(const Node& node) {
    // A tree deeper than its header says is forged.
    if (size_ + kFanOut > links_.size()) {
      count_.complete = false;
      return;
    }
    for (unsigned child = 0; child < node.child_count; ++child)
      if (meets(node, child)) push(node.link[child]);
  }

  bool meets(const Node& node, unsigned child) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (node.lower[axis][child] > box_.upper[axis] || node.upper[axis][child] < box_.lower[axis])
        return false;
    return true;
  }

  void visit_block(const BlockView& block) {
    for (unsigned i = 0; i < block.triangle_count(); ++i) {
      const Triangle triangle = block.triangle(i);
      const auto& [a, b, c] = triangle;
      const Point least = a.cwiseMin(b).cwiseMin(c), greatest = a.cwiseMax(b).cwiseMax(c);
      if ((least.array() > upper_.array()).any() || (greatest.array() < lower_.array()).any())
        continue;
      ++work_.triangles;
      if (lies_on(segment_.from, triangle)) {
        count_.on_surface = true;
        return;
      }
      count_.difference += crossing(segment_, triangle);
    }
  }

  const TreeFacts& tree_;
  const MovedSegment& segment_;
  const Point lower_, upper_;
  const FloatBox box_;
  TreeWork& work_;
  RecordFinder records_;
  Crossings count_;
  std::size_t size_ = 0;
  std::array<std::uint32_t, (kFanOut - 1) * kMaxHeight + 2 * kFanOut> links_;
};

}  // namespace

Crossings count_crossings(const TreeFacts& tree, const MovedSegment& segment,
                          std::uint64_t max_nodes, PageReader pages, TreeWork& work) noexcept {
  return Walk(tree, segment, pages, work).run(max_nodes);
}

}  // namespace planetree::octree
