#include "octree/builder/tree/binary_tree.h"

#include <algorithm>
#include <bit>
#include <span>

#include "octree/builder/tree/area_split.h"
#include "octree/builder/tree/float_rounding.h"
#include "octree/geometry/strict_math.h"
#include "octree/page/frame.h"

namespace planetree::octree {
namespace {

// Index where the highest bit that differs in the sorted range becomes 1; the middle if no bit
// differs.
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
  SubtreeBuilder(const Triangles& mesh, const Point& centre, std::span<MortonKey> keys)
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
    AreaSplitter splitter({items.data(), end - begin});
    const std::uint32_t root = split_items(splitter, begin, 0, end - begin);
    for (std::uint32_t i = begin; i < end; ++i) keys_[i] = splitter.in_split_order(i - begin).key;
    return root;
  }

  // Appends the subtree over the splitter's indices [first, last); index 0 is that of keys[begin].
  std::uint32_t split_items(AreaSplitter& splitter, std::uint32_t begin, std::uint32_t first,
                            std::uint32_t last) {
    const auto at = static_cast<std::uint32_t>(nodes.size());
    nodes.push_back({empty_box(), begin + first, begin + last, 0, 0});
    if (last - first <= kMaxBlockTriangles) {
      for (std::uint32_t i = first; i < last; ++i) extend(nodes[at].box, splitter.at(i).box);
      return at;
    }
    const std::uint32_t middle = first + splitter.split(first, last);
    const std::uint32_t left = split_items(splitter, begin, first, middle);
    const std::uint32_t right = split_items(splitter, begin, middle, last);
    join(at, left, right);
    return at;
  }

  const Triangles& mesh_;
  const Point& centre_;
  std::span<MortonKey> keys_;
};

}  // namespace

std::vector<BinaryNode> build_binary_tree(const Triangles& mesh, const Point& centre,
                                          std::vector<MortonKey>& keys) {
  SubtreeBuilder builder(mesh, centre, keys);
  builder.build(0, static_cast<std::uint32_t>(keys.size()));
  return std::move(builder.nodes);
}

}  // namespace planetree::octree
