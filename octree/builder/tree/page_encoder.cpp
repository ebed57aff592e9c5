#include "octree/builder/tree/page_encoder.h"

#include <algorithm>
#include <array>

#include "octree/builder/tree/block_encoder.h"
#include "octree/builder/tree/stream_writer.h"
#include "octree/page/page_streams.h"

namespace planetree::octree {
namespace {

// Collects the node streams of one page.
class NodeEncoder {
 public:
  NodeEncoder(const PagePlan& plan, std::uint32_t page_number)
      : plan_(plan), page_number_(page_number) {}

  void add(const WideNode& node, bool root, const NodeMoments* moments) {
    if (root) {
      for (const float value : node.box.lower) root_boxes_.push_back(value);
      for (const float value : node.box.upper) root_boxes_.push_back(value);
    }
    child_counts_.push_back(node.child_count);
    heights_.push_back(node.height);
    unsigned kinds = 0;
    for (unsigned i = 0; i < node.child_count; ++i) {
      const WideChild& child = node.children[i];
      packed_.push_back(child.packed);
      kinds |= static_cast<unsigned>(kind_of(child)) << (2 * i);
      if (moments != nullptr) moments_.push_back(moments->child(i));
    }
    kinds_.push_back(static_cast<std::uint16_t>(kinds));
  }

  void describe(PageHead& head) const {
    head.node_count = static_cast<std::uint16_t>(child_counts_.size());
    head.child_count = static_cast<std::uint16_t>(packed_.size());
    head.page_link_count = static_cast<std::uint16_t>(linked_pages_.size());
  }

  void write(StreamWriter& writer) const {
    writer.byte_split(root_boxes_);
    writer.byte_split(child_counts_);
    writer.byte_split(heights_);
    writer.byte_split(kinds_);
    std::vector<std::uint8_t> boxes;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const PackedChild& child : packed_) boxes.push_back(child.lower[axis]);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const PackedChild& child : packed_) boxes.push_back(child.upper[axis]);
    writer.byte_split(boxes);
    std::vector<std::int16_t> normals, slabs;
    std::vector<std::uint16_t> radii;
    for (const PackedChild& child : packed_) normals.push_back(child.normal.u);
    for (const PackedChild& child : packed_) normals.push_back(child.normal.v);
    for (const PackedChild& child : packed_) slabs.push_back(child.slab_lower);
    for (const PackedChild& child : packed_) slabs.push_back(child.slab_upper);
    for (const PackedChild& child : packed_) radii.push_back(child.radius);
    writer.byte_split(normals);
    writer.byte_split(slabs);
    writer.byte_split(radii);
    write_moments(writer);
    writer.byte_split(linked_pages_);
    writer.byte_split(linked_nodes_);
  }

 private:
  void write_moments(StreamWriter& writer) const {
    std::vector<std::int16_t> vectors;
    std::vector<std::int8_t> firsts;
    std::vector<ShortFloat> areas, seconds;
    for (std::size_t i = 0; i < 3; ++i)
      for (const Moments& moments : moments_) vectors.push_back(moments.vector[i]);
    for (std::size_t i = 0; i < 5; ++i)
      for (const Moments& moments : moments_) firsts.push_back(moments.first[i]);
    for (const Moments& moments : moments_) areas.push_back(moments.area);
    for (const Moments& moments : moments_) seconds.push_back(moments.second);
    writer.byte_split(vectors);
    writer.byte_split(firsts);
    writer.byte_split(areas);
    writer.byte_split(seconds);
  }

  ChildKind kind_of(const WideChild& child) {
    const StoredLink link =
        child.block ? plan_.block_links[child.index] : plan_.node_links[child.index];
    if (link.page == page_number_) return child.block ? ChildKind::kBlock : ChildKind::kNode;
    linked_pages_.push_back(link.page);
    linked_nodes_.push_back(link.record);
    return ChildKind::kPage;
  }

  const PagePlan& plan_;
  std::uint32_t page_number_;
  std::vector<float> root_boxes_;
  std::vector<std::uint8_t> child_counts_, heights_;
  std::vector<std::uint16_t> kinds_;
  std::vector<PackedChild> packed_;
  std::vector<Moments> moments_;
  std::vector<std::uint32_t> linked_pages_;
  std::vector<std::uint16_t> linked_nodes_;
};

}  // namespace

EncodedPage PageEncoder::encode(std::size_t which) const {
  const PlannedPage& page = plan_.pages[which];
  NodeEncoder nodes(plan_, page.number);
  BlockEncoder blocks(mesh_, vertices_, keys_, shape_);
  for (std::size_t i = 0; i < page.nodes.size(); ++i)
    nodes.add(tree_.nodes[page.nodes[i]], i < page.root_count,
              shape_.moments ? &tree_.moments[page.nodes[i]] : nullptr);
  for (const std::uint32_t block : page.blocks) blocks.add(tree_.blocks[block]);
  PageHead head{};
  head.page_number = page.number;
  head.octcode = page.octcode;
  head.ordinal = page.ordinal;
  head.root_count = page.root_count;
  nodes.describe(head);
  blocks.describe(head);
  StreamWriter writer;
  writer.plain(&head, sizeof head);
  nodes.write(writer);
  EncodedPage raw;
  raw.link_count = head.page_link_count;
  raw.links_at = static_cast<std::uint32_t>(writer.size() - raw.link_count * kPageLinkBytes);
  blocks.write(writer);
  raw.bytes = writer.take();
  return raw;
}

}  // namespace planetree::octree
