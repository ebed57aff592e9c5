#include "octree/builder/tree/treelets.h"

#include <algorithm>
#include <cassert>

namespace planetree::octree {
namespace {

class TreeletCutter {
 public:
  TreeletCutter(const WideTree& tree, const RecordSlots& slots)
      : tree_(tree), parent_(tree.nodes.size(), 0), left_(tree.nodes.size(), true) {
    cut.cut_nodes.resize(tree.nodes.size());
    for (std::uint32_t at = 0; at < tree.nodes.size(); ++at) {
      const WideNode& node = tree.nodes[at];
      own_slots_.push_back(slots_with_blocks(node, slots));
      for (unsigned i = 0; i < node.child_count; ++i)
        if (!node.children[i].block) parent_[node.children[i].index] = at;
    }
  }

  bool done() const { return !left_[0]; }

  // Cuts every largest subtree of at most `limit` slots from what is left.
  void round(std::uint32_t limit) {
    std::vector<std::uint64_t> slots(own_slots_.begin(), own_slots_.end());
    for (std::size_t i = tree_.nodes.size(); i-- > 1;)
      if (left_[i]) slots[parent_[i]] += slots[i];
    // Parents come first: a node below one that is cut in this round goes with it.
    std::vector<bool> taken(tree_.nodes.size());
    for (std::uint32_t i = 0; i < tree_.nodes.size(); ++i) {
      if (!left_[i]) continue;
      const bool with_parent = i > 0 && taken[parent_[i]];
      if (!with_parent && slots[i] > limit) continue;
      taken[i] = true;
      if (with_parent) continue;
      cut.cut_nodes[i] = true;
      cut.treelets.push_back({i, static_cast<std::uint32_t>(slots[i])});
    }
    for (std::size_t i = 0; i < taken.size(); ++i)
      if (taken[i]) left_[i] = false;
  }

  TreeletCut cut;

 private:
  const WideTree& tree_;
  std::vector<std::uint32_t> own_slots_;  // slots of a node and the blocks kept with it
  std::vector<std::uint32_t> parent_;
  std::vector<bool> left_;  // in no treelet yet
};

}  // namespace

std::uint32_t bottom_slots(std::uint32_t page_bytes, const RecordSlots& slots) {
  const auto quarter = static_cast<std::uint32_t>(page_bytes / 4 / kSlotBytes);
  const std::uint8_t largest = slots.blocks.empty() ? 0 : *std::ranges::max_element(slots.blocks);
  return std::max({quarter, 2048 / static_cast<std::uint32_t>(kSlotBytes), slots.node + largest});
}

std::uint32_t slots_with_blocks(const WideNode& node, const RecordSlots& slots) {
  std::uint32_t together = slots.node;
  for (unsigned i = 0; i < node.child_count; ++i)
    if (node.children[i].block) together += slots.blocks[node.children[i].index];
  return together;
}

TreeletCut cut_treelets(const WideTree& tree, const RecordSlots& slots, std::uint32_t bottom_slots,
                        std::uint32_t upper_slots) {
  assert(!tree.nodes.empty());
  TreeletCutter cutter(tree, slots);
  cutter.round(bottom_slots);
  while (!cutter.done()) cutter.round(upper_slots);
  return std::move(cutter.cut);
}

}  // namespace planetree::octree
