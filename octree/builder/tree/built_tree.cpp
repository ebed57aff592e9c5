#include "octree/builder/tree/built_tree.h"

#include "octree/geometry/strict_math.h"

namespace planetree::octree {

BuiltTree::BuiltTree(const ModelFrame& frame, const PatchTree& above,
                     const std::vector<BuiltPatch>& patches, const BlockShape& shape,
                     std::uint32_t page_bytes, const storage::SpillFile& file)
    : frame_(frame),
      patches_(patches),
      shape_(shape),
      page_bytes_(page_bytes),
      crown_(build_crown(above, patches, shape, page_bytes)),
      numbers_(crown_, patches, page_bytes),
      pages_(crown_, patches, numbers_, shape, file),
      node_count_(crown_.tree.nodes.size()) {
  for (const BuiltPatch& patch : patches) {
    node_count_ += patch.node_count;
    block_count_ += patch.block_count;
  }
}

unsigned BuiltTree::height() const {
  return crown_.tree.nodes.empty() ? patches_[0].height : crown_.tree.nodes[0].height;
}

TreeFacts BuiltTree::facts() const {
  TreeFacts facts;
  facts.page_bytes = page_bytes_;
  facts.root_link = pages_.root_link();
  facts.shape = shape_;
  facts.record_count = node_count_ + block_count_;
  facts.box_lower = frame_.lower();
  facts.box_upper = frame_.upper();
  facts.centre = frame_.centre();
  return facts;
}

PageFacts BuiltTree::facts_of_page(std::uint32_t number) const {
  const NumberedPage& page = numbers_.pages()[number];
  PageFacts facts;
  facts.page_bytes = page_bytes_;
  facts.page_count = pages_.size();
  facts.shape = shape_;
  facts.page_number = number;
  facts.octcode = page.octcode;
  facts.ordinal = page.ordinal;
  return facts;
}

}  // namespace planetree::octree
