#include "octree/build/binary_tree.h"

#include <algorithm>
#include <bit>
#include <span>

#include <tbb/parallel_for.h>

#include "octree/build/area_split.h"
#include "octree/build/float_rounding.h"
#include "octree/frame.h"
#include "octree/strict_math.h"

namespace planetree::octree {
namespace {

// Subtrees of at most this many triangles are built by one task each.
constexpr std::uint32_t kTaskTriangles = 1 << 16;

// Where the highest bit that differs within the sorted range turns to 1; the
// middle where none differs.
std::uint32_t split_by_code(std::span<const MortonKey> keys, std::uint32_t begin,
                            std::uint32_t end) {
  const std::uint64_t differing = keys[begin].code ^ keys[end - 1].code;
  if (differing == 0) return begin + (end - begin) / 2;
  const std::uint64_t bit = std::bit_floor(differing);
  const auto first = keys.begin() + begin;
  const auto last = keys.begin() + end;
  const auto split = std::partition_point(
      first, last, [bit](const MortonKey& key) { return (key.code & bit) == 0; });
  return static_cast<std::uint32_t>(split - keys.begin());
}

class SubtreeBuilder {
 public:
  SubtreeBuilder(const MeshStore& mesh, const Point& centre, std::span<MortonKey> keys)
      : mesh_(mesh), centre_(centre), keys_(keys) {}

  // Appends the subtree over [begin, end); returns its root.
  std::uint32_t build(std::uint32_t begin, std::uint32_t end) {
    if (end - begin <= kMaxAreaSplit) return build_small(begin, end);
    const auto at = static_cast<std::uint32_t>(nodes.size());
    nodes.push_back({{}, begin, end, 0, 0});
    const std::uint32_t middle = split_by_code(keys_, begin, end);
    const std::uint32_t left = build(begin, middle);
    const std::uint32_t right = build(middle, end);
    join(at, left, right);
    return at;
  }

  std::vector<BinaryNode> nodes;

 private:
  void join(std::uint32_t at, std::uint32_t left, std::uint32_t right) {
    nodes[at].left = left;
    nodes[at].right = right;
    nodes[at].box = nodes[left].box;
    extend(nodes[at].box, nodes[right].box);
  }

  std::uint32_t build_small(std::uint32_t begin, std::uint32_t end) {
    std::array<SplitItem, kMaxAreaSplit> items;
    for (std::uint32_t i = begin; i < end; ++i) {
      SplitItem& item = items[i - begin];
      item = {keys_[i], empty_box()};
      for (const Point& corner : mesh_.corners(keys_[i].position))
        extend(item.box, corner - centre_);
    }
    const std::span<SplitItem> used(items.data(), end - begin);
    const std::uint32_t root = split_items(used, begin);
    for (std::uint32_t i = begin; i < end; ++i) keys_[i] = items[i - begin].key;
    return root;
  }

  std::uint32_t split_items(std::span<SplitItem> items, std::uint32_t begin) {
    const auto at = static_cast<std::uint32_t>(nodes.size());
    const auto count = static_cast<std::uint32_t>(items.size());
    nodes.push_back({empty_box(), begin, begin + count, 0, 0});
    if (count <= kMaxBlockTriangles) {
      for (const SplitItem& item : items) extend(nodes[at].box, item.box);
      return at;
    }
    const std::uint32_t left_count = split_by_area(items);
    const std::uint32_t left = split_items(items.first(left_count), begin);
    const std::uint32_t right = split_items(items.subspan(left_count), begin + left_count);
    join(at, left, right);
    return at;
  }

  const MeshStore& mesh_;
  const Point& centre_;
  std::span<MortonKey> keys_;
};

// The nodes above the tasks' subtrees, whose roots stand in for them until
// they are built.
struct Top {
  std::vector<BinaryNode> nodes;
  std::vector<std::uint32_t> tasks;  // nodes to be replaced by subtrees

  std::uint32_t split(std::span<const MortonKey> keys, std::uint32_t begin, std::uint32_t end) {
    const auto at = static_cast<std::uint32_t>(nodes.size());
    nodes.push_back({{}, begin, end, 0, 0});
    if (end - begin <= kTaskTriangles) {
      tasks.push_back(at);
      return at;
    }
    const std::uint32_t middle = split_by_code(keys, begin, end);
    const std::uint32_t left = split(keys, begin, middle);
    const std::uint32_t right = split(keys, middle, end);
    nodes[at].left = left;
    nodes[at].right = right;
    return at;
  }
};

// Puts a subtree in the place of the node that stood for it.
void graft(std::vector<BinaryNode>& nodes, std::uint32_t at, std::span<const BinaryNode> subtree) {
  // Node 0 of the subtree goes to `at`, node i > 0 to shift + i.
  const auto shift = static_cast<std::uint32_t>(nodes.size()) - 1;
  const auto moved = [shift](BinaryNode node) {
    if (!node.leaf()) {
      node.left += shift;
      node.right += shift;
    }
    return node;
  };
  nodes[at] = moved(subtree[0]);
  for (const BinaryNode& node : subtree.subspan(1)) nodes.push_back(moved(node));
}

}  // namespace

std::vector<BinaryNode> build_binary_tree(const MeshStore& mesh, const Point& centre,
                                          std::vector<MortonKey>& keys) {
  Top top;
  top.split(keys, 0, static_cast<std::uint32_t>(keys.size()));
  const auto top_count = static_cast<std::uint32_t>(top.nodes.size());
  std::vector<std::vector<BinaryNode>> subtrees(top.tasks.size());
  tbb::parallel_for(std::size_t{0}, top.tasks.size(), [&](std::size_t i) {
    const BinaryNode& stand_in = top.nodes[top.tasks[i]];
    SubtreeBuilder builder(mesh, centre, keys);
    builder.build(stand_in.begin, stand_in.end);
    subtrees[i] = std::move(builder.nodes);
  });
  std::vector<BinaryNode> nodes = std::move(top.nodes);
  for (std::size_t i = 0; i < subtrees.size(); ++i) {
    graft(nodes, top.tasks[i], subtrees[i]);
    subtrees[i] = {};
  }
  // Children come after their parents, so one pass backwards joins the boxes.
  const std::vector<std::uint32_t>& tasks = top.tasks;
  for (std::uint32_t at = top_count; at-- > 0;) {
    if (std::binary_search(tasks.begin(), tasks.end(), at)) continue;
    nodes[at].box = nodes[nodes[at].left].box;
    extend(nodes[at].box, nodes[nodes[at].right].box);
  }
  return nodes;
}

}  // namespace planetree::octree
