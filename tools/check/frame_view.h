#pragma once

#include <cstddef>
#include <cstdint>

#include "octree/page/block_table.h"
#include "octree/page/frame.h"
#include "octree/page/moments.h"

namespace planetree::tools {

/// The records of a distance page that FileParts decoded, by their numbers. Roots of subtrees come
/// first, among the nodes and among the blocks. `frame` must outlive this.
class FrameView {
 public:
  FrameView(const std::byte* frame, const octree::BlockShape& shape)
      : frame_(frame), shape_(shape) {}

  const octree::FrameHeader& header() const {
    return *reinterpret_cast<const octree::FrameHeader*>(frame_);
  }

  std::uint32_t node_count() const { return header().node_count; }
  const octree::Node& node(std::uint32_t index) const {
    const std::uint32_t slot = header().first_node_slot + shape_.node_slots() * index;
    return *reinterpret_cast<const octree::Node*>(at(slot));
  }

  /// Moments of a child; zeros in a file without moments.
  octree::Moments moments(const octree::Node& node, unsigned child) const {
    return shape_.moments ? octree::NodeMoments::of(node).child(child) : octree::Moments();
  }

  std::uint32_t block_count() const { return header().block_count; }
  octree::BlockView block(std::uint32_t index) const {
    return {at(octree::BlockTable(frame_).slot(index)), shape_};
  }
  /// Calls visit(index, block) for every block.
  template <class Visit>
  void for_each_block(Visit visit) const {
    for (std::uint32_t i = 0; i < block_count(); ++i) visit(i, block(i));
  }

 private:
  const std::byte* at(std::uint32_t slot) const {
    return frame_ + std::size_t{slot} * octree::kSlotBytes;
  }
  const std::byte* frame_;
  octree::BlockShape shape_;
};

inline octree::Disc child_disc(const octree::Node& node, unsigned child) {
  return {{node.normal[0][child], node.normal[1][child], node.normal[2][child]},
          node.slab_lower[child],
          node.slab_upper[child],
          node.radius[child]};
}

}  // namespace planetree::tools
