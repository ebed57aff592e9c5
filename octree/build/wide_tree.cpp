#include "octree/build/wide_tree.h"

#include <algorithm>
#include <cmath>

#include "octree/build/float_rounding.h"
#include "octree/strict_math.h"

namespace planetree::octree {
namespace {

struct Opening {
  std::array<std::uint32_t, kFanOut> child{};
  unsigned count = 0;
};

// The child to open next; kFanOut if all are leaves.
unsigned largest_inner(const std::vector<BinaryNode>& binary, const Opening& opening) {
  unsigned best = kFanOut;
  for (unsigned i = 0; i < opening.count; ++i) {
    const BinaryNode& node = binary[opening.child[i]];
    if (node.leaf()) continue;
    if (best == kFanOut) {
      best = i;
      continue;
    }
    const BinaryNode& other = binary[opening.child[best]];
    const float area = half_area(node.box), other_area = half_area(other.box);
    if (area > other_area || (area == other_area && node.count() > other.count())) best = i;
  }
  return best;
}

Opening open_children(const std::vector<BinaryNode>& binary, const BinaryNode& node) {
  Opening opening;
  opening.child[0] = node.left;
  opening.child[1] = node.right;
  opening.count = 2;
  while (opening.count < kFanOut) {
    const unsigned at = largest_inner(binary, opening);
    if (at == kFanOut) break;
    const BinaryNode& opened = binary[opening.child[at]];
    for (unsigned i = opening.count; i > at + 1; --i) opening.child[i] = opening.child[i - 1];
    opening.child[at] = opened.left;
    opening.child[at + 1] = opened.right;
    ++opening.count;
  }
  return opening;
}

// The least steps from a side of the parent that decode to a box around the
// true one.
void pack_box(const FloatBox& parent, WideChild& child) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float low = parent.lower[axis], high = parent.upper[axis];
    const float step = (high - low) * (1.0f / 255.0f);
    const auto guess = [&](float value) {
      const float steps = step > 0 ? (value - low) / step : 0.0f;
      return static_cast<int>(std::clamp(steps, 0.0f, 255.0f));
    };
    int lower = std::min(guess(child.true_box.lower[axis]) + 1, 254);
    while (lower > 0 && unpack_coordinate(low, high, static_cast<std::uint8_t>(lower)) >
                            child.true_box.lower[axis])
      --lower;
    int upper = std::max(guess(child.true_box.upper[axis]) - 1, lower);
    while (upper < 255 && unpack_coordinate(low, high, static_cast<std::uint8_t>(upper)) <
                              child.true_box.upper[axis])
      ++upper;
    child.packed.lower[axis] = static_cast<std::uint8_t>(lower);
    child.packed.upper[axis] = static_cast<std::uint8_t>(upper);
  }
  child.box = unpack_box(parent, child.packed);
}

class Collapser {
 public:
  Collapser(const std::vector<BinaryNode>& binary, WideTree& tree) : binary_(binary), tree_(tree) {}

  // Appends the wide node for binary node `from`, whose decoded box is `box`.
  std::uint32_t add_node(std::uint32_t from, const FloatBox& box) {
    const auto at = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.emplace_back();
    const Opening opening = open_children(binary_, binary_[from]);
    tree_.nodes[at].box = box;
    tree_.nodes[at].child_count = static_cast<std::uint8_t>(opening.count);
    unsigned height = 0;
    for (unsigned i = 0; i < opening.count; ++i) {
      WideChild child = make_child(binary_[opening.child[i]]);
      pack_box(box, child);
      if (child.block) {
        child.index = add_block(child.begin, child.end);
      } else {
        child.index = add_node(opening.child[i], child.box);
        height = std::max<unsigned>(height, tree_.nodes[child.index].height);
      }
      tree_.nodes[at].children[i] = child;
    }
    tree_.nodes[at].height = static_cast<std::uint8_t>(height + 1);
    return at;
  }

  std::uint32_t add_block(std::uint32_t begin, std::uint32_t end) {
    tree_.blocks.push_back({begin, end});
    return static_cast<std::uint32_t>(tree_.blocks.size() - 1);
  }

 private:
  static WideChild make_child(const BinaryNode& node) {
    WideChild child;
    child.block = node.leaf();
    child.begin = node.begin;
    child.end = node.end;
    child.true_box = node.box;
    return child;
  }

  const std::vector<BinaryNode>& binary_;
  WideTree& tree_;
};

}  // namespace

WideTree collapse(const std::vector<BinaryNode>& binary) {
  WideTree tree;
  Collapser collapser(binary, tree);
  if (binary[0].leaf())
    collapser.add_block(binary[0].begin, binary[0].end);
  else
    collapser.add_node(0, binary[0].box);
  return tree;
}

}  // namespace planetree::octree
