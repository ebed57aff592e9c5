#include "octree/builder/tree/built_tree.h"

#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

BlockShape with_numbers(BlockShape shape) {
  shape.links = LinkTarget::kNumber;
  return shape;
}

}  // namespace

BuiltTree::BuiltTree(const ModelFrame& frame, const ChunkTree& above,
                     const std::vector<BuiltChunk>& chunks, const BlockShape& shape,
                     std::uint32_t page_bytes, const storage::SpillFile& file,
                     std::uint32_t first_page)
    : frame_(frame),
      chunks_(chunks),
      shape_(with_numbers(shape)),
      page_bytes_(page_bytes),
      top_tree_(build_top_tree(above, chunks, shape, page_bytes)),
      numbers_(top_tree_, chunks, page_bytes, first_page),
      pages_(top_tree_, chunks, numbers_, shape, file),
      node_count_(top_tree_.tree.nodes.size()) {
  for (const BuiltChunk& chunk : chunks) {
    node_count_ += chunk.node_count;
    block_count_ += chunk.block_count;
  }
}

unsigned BuiltTree::height() const {
  return top_tree_.tree.nodes.empty() ? chunks_[0].height : top_tree_.tree.nodes[0].height;
}

TreeInfo BuiltTree::info() const {
  TreeInfo info;
  info.page_bytes = page_bytes_;
  info.first_page = pages_.first();
  info.root_link = root_link_of(page_bytes_, shape_.links, pages_.first(), node_count_);
  info.shape = shape_;
  info.record_count = node_count_ + block_count_;
  info.box_lower = frame_.lower();
  info.box_upper = frame_.upper();
  info.core_lower = frame_.core_lower();
  info.core_upper = frame_.core_upper();
  info.set_strays(frame_.stray_count, frame_.stray_edge);
  info.centre = frame_.centre();
  return info;
}

PageInfo BuiltTree::info_of_page(std::uint32_t number) const {
  const NumberedPage& page = numbers_.page(number);
  PageInfo info;
  info.page_bytes = page_bytes_;
  info.first_page = pages_.first();
  info.page_count = pages_.size();
  info.shape = shape_;
  info.page_number = number;
  info.octcode = page.octcode;
  return info;
}

}  // namespace planetree::octree
