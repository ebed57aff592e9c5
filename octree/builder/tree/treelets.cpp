#include "octree/builder/tree/treelets.h"

namespace planetree::octree {
namespace {

class TreeletCutter {
 public:
  TreeletCutter(const WideTree& tree, const RecordSlots& slots, std::uint32_t bottom_slots)
      : tree_(tree),
        slots_(slots),
        own_slots_(tree.nodes.size(), slots.node),
        parent_(tree.nodes.size(), 0),
        left_(tree.nodes.size(), true) {
    cut.cut_nodes.resize(tree.nodes.size());
    cut.cut_blocks.resize(tree.blocks.size());
    for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) assign_blocks(i, bottom_slots);
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
      cut.treelets.push_back({{false, i}, static_cast<std::uint32_t>(slots[i])});
    }
    for (std::size_t i = 0; i < taken.size(); ++i)
      if (taken[i]) left_[i] = false;
  }

  TreeletCut cut;

 private:
  // If a node is too large together with its blocks, each of them is a treelet by itself.
  void assign_blocks(std::uint32_t at, std::uint32_t bottom_slots) {
    const WideNode& node = tree_.nodes[at];
    std::uint32_t together = slots_.node;
    for (unsigned i = 0; i < node.child_count; ++i) {
      const WideChild& child = node.children[i];
      if (child.block)
        together += slots_.blocks[child.index];
      else
        parent_[child.index] = at;
    }
    if (together <= bottom_slots) {
      own_slots_[at] = together;
      return;
    }
    for (unsigned i = 0; i < node.child_count; ++i) {
      const WideChild& child = node.children[i];
      if (!child.block) continue;
      cut.cut_blocks[child.index] = true;
      cut.treelets.push_back({{true, child.index}, slots_.blocks[child.index]});
    }
  }

  const WideTree& tree_;
  const RecordSlots& slots_;
  std::vector<std::uint32_t> own_slots_;  // slots of a node and the blocks kept with it
  std::vector<std::uint32_t> parent_;
  std::vector<bool> left_;  // in no treelet yet
};

}  // namespace

TreeletCut cut_treelets(const WideTree& tree, const RecordSlots& slots, std::uint32_t bottom_slots,
                        std::uint32_t upper_slots) {
  if (tree.nodes.empty()) {
    TreeletCut cut;
    cut.treelets.push_back({{true, 0}, slots.blocks[0]});
    cut.cut_blocks.push_back(true);
    return cut;
  }
  TreeletCutter cutter(tree, slots, bottom_slots);
  cutter.round(bottom_slots);
  while (!cutter.done()) cutter.round(upper_slots);
  return std::move(cutter.cut);
}

}  // namespace planetree::octree
