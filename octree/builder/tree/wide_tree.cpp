#include "octree/builder/tree/wide_tree.h"

#include <algorithm>
#include <cmath>

#include "octree/builder/tree/float_rounding.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

struct Opening {
  std::array<std::uint32_t, kFanOut> child{};
  unsigned count = 0;
};

// Chooses the binary nodes that become wide nodes so that the sum of their surface areas is least,
// since a query visits a node about as often as its surface is large. Uses dynamic programming over
// the number of children that a subtree may give to the wide node above it, as compressed wide
// trees for rays do (Ylitie, Karras & Laine 2017, "Efficient incoherent ray traversal on GPUs
// through compressed wide BVHs", section 4.2). Blocks stay as they are.
class OpenedChildren {
 public:
  explicit OpenedChildren(const std::vector<BinaryNode>& binary)
      : binary_(binary), min_(binary.size()) {
    // Children come after their parents.
    for (auto at = static_cast<std::uint32_t>(binary.size()); at-- > 0;) weigh(at);
  }

  // The children of a wide node, in order.
  Opening of(std::uint32_t at) const {
    Opening opening;
    open(at, kFanOut, opening);
    return opening;
  }

 private:
  static constexpr unsigned kMaxShare = kFanOut - 1;

  // Least surface area of a subtree that may give up to `share` children.
  float least(std::uint32_t at, unsigned share) const { return min_[at][share - 1]; }

  // The first of the best shares for the left half; the right half gets the rest.
  unsigned best_share(const BinaryNode& node, unsigned share) const {
    const auto surface = [&](unsigned left) {
      return least(node.left, left) + least(node.right, share - left);
    };
    unsigned best = 1;
    for (unsigned left = 2; left < share; ++left)
      if (surface(left) < surface(best)) best = left;
    return best;
  }
  float divided(const BinaryNode& node, unsigned share) const {
    const unsigned left = best_share(node, share);
    return least(node.left, left) + least(node.right, share - left);
  }

  void weigh(std::uint32_t at) {
    const BinaryNode& node = binary_[at];
    if (node.leaf()) return;  // a block costs the same below any node
    min_[at][0] = half_area(node.box) + divided(node, kFanOut);
    for (unsigned share = 2; share <= kMaxShare; ++share)
      min_[at][share - 1] = std::min(min_[at][0], divided(node, share));
  }

  // Appends what a subtree gives: itself, or what its halves give.
  void give(std::uint32_t at, unsigned share, Opening& opening) const {
    const bool whole = binary_[at].leaf() || share == 1 || least(at, share) == least(at, 1);
    if (whole)
      opening.child[opening.count++] = at;
    else
      open(at, share, opening);
  }
  void open(std::uint32_t at, unsigned share, Opening& opening) const {
    const BinaryNode& node = binary_[at];
    const unsigned left = best_share(node, share);
    give(node.left, left, opening);
    give(node.right, share - left, opening);
  }

  const std::vector<BinaryNode>& binary_;
  std::vector<std::array<float, kMaxShare>> min_;  // least surface area, by share
};

// Greatest number of steps that do not pass the true side, as holds(distance) says, within a limit.
template <class Holds>
std::uint8_t max_steps(float distance, float step, int max_count, const Holds& holds) {
  const float guess = step > 0 ? distance / step : 0.0f;
  int steps = std::min(static_cast<int>(std::clamp(guess, 0.0f, 254.0f)) + 1, max_count);
  while (steps > 0 && !holds(static_cast<float>(steps) * step)) --steps;
  return static_cast<std::uint8_t>(steps);
}

// Packs the maximum steps from the parent's sides that decode to a box around the true box.
void pack_box(const FloatBox& parent, WideChild& child) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float low = parent.lower[axis], high = parent.upper[axis];
    const float lower = child.true_box.lower[axis], upper = child.true_box.upper[axis];
    const float step = box_step(low, high);
    child.packed.lower[axis] =
        max_steps(lower - low, step, kBoxSteps - 1, [&](float way) { return low + way <= lower; });
    child.packed.upper[axis] = max_steps(high - upper, step, kBoxSteps - child.packed.lower[axis],
                                         [&](float way) { return high - way >= upper; });
  }
  child.box = unpack_box(parent, child.packed);
}

class Collapser {
 public:
  Collapser(const std::vector<BinaryNode>& binary, bool keeps_root, WideTree& tree)
      : binary_(binary), opened_(binary), keeps_root_(keeps_root), tree_(tree) {}

  // Appends the wide node for binary node `from`, whose decoded box is `box`.
  std::uint32_t add_node(std::uint32_t from, const FloatBox& box) {
    const auto at = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.emplace_back();
    const bool is_kept_root = from == 0 && keeps_root_;
    const Opening opening =
        is_kept_root ? Opening{{binary_[0].left, binary_[0].right}, 2} : opened_.of(from);
    tree_.nodes[at].box = box;
    tree_.nodes[at].child_count = static_cast<std::uint8_t>(opening.count);
    unsigned height = 0;
    for (unsigned i = 0; i < opening.count; ++i) {
      WideChild child = make_child(binary_[opening.child[i]]);
      pack_box(box, child);
      if (child.block) {
        child.index = add_block(child.begin, child.end);
      } else {
        // A child of a kept root begins a page, which stores its box as it is.
        child.index = add_node(opening.child[i], is_kept_root ? child.true_box : child.box);
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
  const OpenedChildren opened_;
  const bool keeps_root_;
  WideTree& tree_;
};

// Returns a node with this box whose only child is a block.
WideNode node_of_block(const FloatBox& box, WideChild block) {
  pack_box(box, block);
  WideNode node;
  node.box = box;
  node.child_count = 1;
  node.height = 1;
  node.children[0] = block;
  return node;
}

}  // namespace

WideTree collapse(const std::vector<BinaryNode>& binary, bool keeps_root) {
  WideTree tree;
  Collapser collapser(binary, keeps_root, tree);
  if (binary[0].leaf())
    collapser.add_block(binary[0].begin, binary[0].end);
  else
    collapser.add_node(0, binary[0].box);
  return tree;
}

void part_block(WideTree& tree, std::uint32_t node, unsigned child) {
  const WideChild block = tree.nodes[node].children[child];
  WideChild& parted = tree.nodes[node].children[child];
  parted.block = false;
  parted.index = static_cast<std::uint32_t>(tree.nodes.size());
  tree.nodes.push_back(node_of_block(block.box, block));
}

void add_root(WideTree& tree, const FloatBox& box) {
  const WideBlock& all = tree.blocks[0];
  WideChild block;
  block.block = true;
  block.begin = all.begin;
  block.end = all.end;
  block.true_box = box;
  tree.nodes.push_back(node_of_block(box, block));
}

void raise_heights(WideTree& tree) {
  // Children come after their parents.
  for (auto node = tree.nodes.rbegin(); node != tree.nodes.rend(); ++node) {
    unsigned height = 0;
    for (unsigned i = 0; i < node->child_count; ++i)
      if (!node->children[i].block)
        height = std::max<unsigned>(height, tree.nodes[node->children[i].index].height);
    node->height = static_cast<std::uint8_t>(height + 1);
  }
}

}  // namespace planetree::octree
