#include "octree/builder/tree/top_tree.h"

#include <algorithm>
#include <numeric>

#include "octree/builder/tree/binary_tree.h"
#include "octree/builder/tree/disc_fit.h"
#include "octree/builder/tree/float_rounding.h"
#include "octree/geometry/octcode.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

std::vector<BinaryNode> binary_above(const ChunkTree& above,
                                     const std::vector<BuiltChunk>& chunks) {
  std::vector<BinaryNode> nodes;
  for (const ChunkNode& node : above.nodes)
    nodes.push_back({empty_box(), node.begin, node.end, node.left, node.right});
  // Children come after their parents.
  for (std::size_t at = nodes.size(); at-- > 0;) {
    BinaryNode& node = nodes[at];
    if (node.leaf()) {
      node.box = chunks[node.begin].box;
    } else {
      node.box = nodes[node.left].box;
      extend(node.box, nodes[node.right].box);
    }
  }
  return nodes;
}

class TopTreeBuilder {
 public:
  TopTreeBuilder(const std::vector<BuiltChunk>& chunks, const BlockShape& shape, WideTree& tree)
      : chunks_(chunks), shape_(shape), tree_(tree) {}

  void run() {
    std::vector<SurfaceSums> sums(tree_.nodes.size());
    if (shape_.moments) tree_.moments.resize(tree_.nodes.size());
    // Children come after their parents.
    for (std::size_t at = tree_.nodes.size(); at-- > 0;) {
      raise(tree_.nodes[at]);
      fit(tree_.nodes[at]);
      if (shape_.moments) sum(at, sums);
    }
  }

 private:
  void raise(WideNode& node) const {
    unsigned height = 0;
    for (unsigned i = 0; i < node.child_count; ++i) {
      const WideChild& child = node.children[i];
      const unsigned below =
          child.block ? chunks_[child.index].height : tree_.nodes[child.index].height;
      height = std::max(height, below);
    }
    node.height = static_cast<std::uint8_t>(height + 1);
  }

  void fit(WideNode& node) const {
    for (unsigned i = 0; i < node.child_count; ++i) {
      WideChild& child = node.children[i];
      const Point area = std::accumulate(
          chunks_.begin() + child.begin, chunks_.begin() + child.end, Point(Point::Zero()),
          [](const Point& sum, const BuiltChunk& chunk) { return Point(sum + chunk.area); });
      fit_disc(child, normal_of(area),
               child.block ? chunks_[child.index].boxes_below
                           : octree::boxes_below(tree_, tree_.nodes[child.index]));
    }
  }

  void sum(std::size_t at, std::vector<SurfaceSums>& sums) const {
    const WideNode& node = tree_.nodes[at];
    for (unsigned i = 0; i < node.child_count; ++i) {
      const WideChild& child = node.children[i];
      SurfaceSums below = child.block ? chunks_[child.index].sums : sums[child.index];
      if (child.block) below.move(centre_of(chunks_[child.index].box) - centre_of(child.box));
      tree_.moments[at].set(i, packed(below, child.box));
      below.move(centre_of(child.box) - centre_of(node.box));
      sums[at].add(below);
    }
  }

  const std::vector<BuiltChunk>& chunks_;
  const BlockShape& shape_;
  WideTree& tree_;
};

/// Packs the nodes into pages, breadth first. Nodes that hang from one page share pages; nodes that
/// hang from different pages do not.
class TopTreePlanner {
 public:
  // keeps_root  as for collapse().
  TopTreePlanner(const WideTree& tree, const std::vector<BuiltChunk>& chunks, bool keeps_root,
                 std::size_t capacity)
      : tree_(tree), chunks_(chunks), keeps_root_(keeps_root), capacity_(capacity) {}

  std::vector<PlannedPage> run() {
    if (tree_.nodes.empty()) return {};
    start({0});
    for (std::size_t i = 0; i < pages_.size(); ++i) {
      const std::vector<std::uint32_t> left =
          fill(pages_[i], i == 0 && keeps_root_ ? 1 : capacity_);
      const std::size_t roots = std::min(kRoots, capacity_);
      for (std::size_t first = 0; first < left.size(); first += roots) {
        const std::size_t last = std::min(first + roots, left.size());
        start({left.begin() + static_cast<std::ptrdiff_t>(first),
               left.begin() + static_cast<std::ptrdiff_t>(last)});
      }
    }
    return std::move(pages_);
  }

 private:
  // Maximum number of subtrees that a page begins with: enough to share it, few enough to go deep.
  static constexpr std::size_t kRoots = 8;

  void start(std::vector<std::uint32_t> roots) {
    PlannedPage page;
    page.octcode = ~std::uint64_t{0};
    for (const std::uint32_t root : roots) page.octcode = std::min(page.octcode, octcode_of(root));
    page.root_count = static_cast<std::uint16_t>(roots.size());
    page.nodes = std::move(roots);
    pages_.push_back(std::move(page));
  }

  // Returns the nodes that do not fit.
  std::vector<std::uint32_t> fill(PlannedPage& page, std::size_t capacity) const {
    std::vector<std::uint32_t> left;
    for (std::size_t i = 0; i < page.nodes.size(); ++i) {
      const WideNode& node = tree_.nodes[page.nodes[i]];
      for (unsigned c = 0; c < node.child_count; ++c) {
        if (node.children[c].block) continue;
        (page.nodes.size() < capacity ? page.nodes : left).push_back(node.children[c].index);
      }
    }
    return left;
  }

  std::uint64_t octcode_of(std::uint32_t at) const {
    const WideNode& node = tree_.nodes[at];
    std::uint64_t least = ~std::uint64_t{0}, greatest = 0;
    // Codes ascend within a child. Those of strays may be less than those of the core before them.
    for (unsigned i = 0; i < node.child_count; ++i) {
      least = std::min(least, chunks_[node.children[i].begin].min_code);
      greatest = std::max(greatest, chunks_[node.children[i].end - 1].greatest_code);
    }
    return octcode_of_range(least, greatest);
  }

  const WideTree& tree_;
  const std::vector<BuiltChunk>& chunks_;
  const bool keeps_root_;
  const std::size_t capacity_;
  std::vector<PlannedPage> pages_;
};

}  // namespace

TopTree build_top_tree(const ChunkTree& above, const std::vector<BuiltChunk>& chunks,
                       const BlockShape& shape, std::uint32_t page_bytes) {
  TopTree top_tree;
  top_tree.tree = collapse(binary_above(above, chunks), above.parts_strays);
  TopTreeBuilder(chunks, shape, top_tree.tree).run();
  const std::size_t slots = page_bytes / kSlotBytes - frame_head_slots(page_bytes);
  top_tree.plan.page_bytes = page_bytes;
  top_tree.plan.pages =
      TopTreePlanner(top_tree.tree, chunks, above.parts_strays, slots / shape.node_slots()).run();
  return top_tree;
}

}  // namespace planetree::octree
