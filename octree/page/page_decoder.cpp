#include "octree/page/page_decoder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "octree/geometry/strict_math.h"
#include "octree/page/block_decoder.h"
#include "octree/page/frame.h"
#include "octree/page/moments.h"
#include "octree/page/node_unpacking.h"
#include "octree/page/page_streams.h"

namespace planetree::octree {
namespace {

// Layout of the page's records in the frame, computed before any is unpacked.
struct FramePlan {
  std::uint16_t first_node_slot = 0;
  std::uint16_t first_block_slot = 0;
  std::uint32_t used_bytes = 0;
};

class PageDecoder {
 public:
  PageDecoder(const PageInfo& info, std::span<std::byte> frame)
      : info_(info), links_(info.page_bytes, info.shape.links), frame_(frame.data()) {}

  const char* decode(std::span<const std::byte> raw) {
    if (const char* fault = streams_.read(raw, info_.shape)) return fault;
    if (const char* fault = fault_of_key(streams_.head, info_)) return fault;
    if (const char* fault = plan()) return fault;
    write_header();
    if (const char* fault = decode_nodes()) return fault;
    return decode_blocks();
  }

 private:
  const char* plan();
  unsigned block_slots(std::size_t block) const {
    return info_.shape.slots(streams_.vertex_counts[block], streams_.compact(block));
  }
  void write_header();
  const char* decode_nodes();
  const char* decode_lone_block() const;
  const char* decode_node(std::size_t index);
  template <class Bytes>
  void copy_children(const std::byte* plane, std::size_t count, Bytes& bytes) const;
  const char* decode_bounds(Node& node, std::size_t count) const;
  const char* decode_child(Node& node, std::size_t child, ChildKind kind);
  const char* decode_moments(Node& node, std::size_t child);
  const char* link_to_node(Node& node, std::size_t child);
  const char* link_to_block(Node& node, std::size_t child);
  const char* link_to_page(Node& node, std::size_t child);
  const char* decode_blocks();

  Node* node(std::size_t index) {
    return reinterpret_cast<Node*>(frame_ + node_slot(index) * kSlotBytes);
  }
  std::size_t node_slot(std::size_t index) const {
    return plan_.first_node_slot + info_.shape.node_slots() * index;
  }

  const PageInfo& info_;
  const LinkFormat links_;
  const bool to_slots_ = links_.target() == LinkTarget::kSlot;
  std::byte* frame_;
  RawStreams streams_;
  FramePlan plan_;
  std::size_t next_child_ = 0;
  std::size_t next_node_ = 0;
  std::size_t next_block_ = 0;
  std::size_t next_block_slot_ = 0;
  std::size_t next_page_link_ = 0;
};

const char* PageDecoder::plan() {
  const PageHead& head = streams_.head;
  std::size_t slots = frame_head_slots(info_.page_bytes);
  plan_.first_node_slot = static_cast<std::uint16_t>(slots);
  slots += std::size_t{info_.shape.node_slots()} * head.node_count;
  const std::size_t first_block_slot = slots;
  for (std::size_t i = 0; i < head.block_count; ++i) {
    if (streams_.compact(i) && !info_.shape.may_be_compact(streams_.vertex_counts[i]))
      return "a block is compact that cannot be";
    slots += block_slots(i);
  }
  if (slots * kSlotBytes > info_.page_bytes) return "its records do not fit a page";
  plan_.first_block_slot = static_cast<std::uint16_t>(first_block_slot);
  plan_.used_bytes = static_cast<std::uint32_t>(slots * kSlotBytes);
  next_block_slot_ = first_block_slot;
  return nullptr;
}

void PageDecoder::write_header() {
  const PageHead& head = streams_.head;
  std::memset(frame_, 0, plan_.first_node_slot * kSlotBytes);
  FrameHeader header{};
  header.page_number = head.page_number;
  header.used_bytes = plan_.used_bytes;
  header.octcode = head.octcode;
  header.ordinal = head.ordinal;
  header.node_count = head.node_count;
  header.block_count = head.block_count;
  header.root_count = head.root_count;
  header.first_node_slot = plan_.first_node_slot;
  header.first_block_slot = plan_.first_block_slot;
  header.page_link_count = head.page_link_count;
  std::memcpy(frame_, &header, sizeof header);
}

const char* PageDecoder::decode_nodes() {
  const PageHead& head = streams_.head;
  if (head.node_count == 0) return decode_lone_block();
  next_node_ = head.root_count;
  for (std::size_t i = 0; i < head.root_count; ++i) {
    FloatBox box;
    for (int axis = 0; axis < 3; ++axis) {
      box.lower[axis] = streams_.root_boxes[6 * i + axis];
      box.upper[axis] = streams_.root_boxes[6 * i + 3 + axis];
      if (!std::isfinite(box.lower[axis]) || !std::isfinite(box.upper[axis]) ||
          box.lower[axis] > box.upper[axis])
        return "a subtree's box is not a box";
    }
    node(i)->box = box;
  }
  for (std::size_t i = 0; i < head.node_count; ++i) {
    if (i >= next_node_) return "a node has no parent";
    if (const char* fault = decode_node(i)) return fault;
  }
  if (next_node_ != head.node_count || next_block_ != head.block_count ||
      next_child_ != head.child_count || next_page_link_ != head.page_link_count)
    return "its children do not add up";
  return nullptr;
}

// A block without a node is a whole tree.
const char* PageDecoder::decode_lone_block() const {
  const bool alone = streams_.head.block_count == 1 && info_.page_count == 1;
  return alone ? nullptr : "a block has no parent";
}

const char* PageDecoder::decode_node(std::size_t index) {
  Node& target = *node(index);
  const std::size_t count = streams_.child_counts[index];
  if (count == 0 || count > kFanOut) return "a node's child count is out of range";
  if (count > streams_.head.child_count - next_child_) return "its children do not add up";
  const std::uint8_t height = streams_.heights[index];
  if (height == 0 || height > kMaxHeight) return "a node's height is out of range";
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!std::isfinite(target.box.upper[axis] - target.box.lower[axis]))
      return "a node's box is too large";
  // Infinite if the box is so large that discs in it have no unit.
  const float gate = target.box.diagonal_squared() * (1.0f / 64.0f);
  if (const char* fault = decode_bounds(target, count)) return fault;
  std::memset(target.link, 0, sizeof target.link);
  std::memset(target.reserved, 0, sizeof target.reserved);
  if (info_.shape.moments) std::memset(static_cast<void*>(&target + 1), 0, sizeof(NodeMoments));
  target.child_count = static_cast<std::uint8_t>(count);
  target.height = height;
  target.gate = gate;
  const std::uint16_t kinds = streams_.child_kinds[index];
  if (count < kFanOut && kinds >> (2 * count) != 0) return "an absent child has a kind";
  for (std::size_t child = 0; child < count; ++child, ++next_child_) {
    const auto kind = static_cast<ChildKind>(kinds >> (2 * child) & 3);
    if (const char* fault = decode_child(target, child, kind)) return fault;
  }
  return nullptr;
}

// Copies the bytes of the next `count` children from a plane and clears the rest.
template <class Bytes>
void PageDecoder::copy_children(const std::byte* plane, std::size_t count, Bytes& bytes) const {
  static_assert(sizeof bytes == kFanOut);
  if (next_child_ + kFanOut <= streams_.head.child_count)
    std::memcpy(std::data(bytes), plane + next_child_, kFanOut);
  else
    std::memcpy(std::data(bytes), plane + next_child_, count);
  if (count < kFanOut) std::fill(std::begin(bytes) + count, std::end(bytes), std::uint8_t{0});
}

const char* PageDecoder::decode_bounds(Node& parent, std::size_t count) const {
  const std::size_t all = streams_.head.child_count;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    parent.step[axis] = box_step(parent.box.lower[axis], parent.box.upper[axis]);
    copy_children(streams_.child_boxes.bytes() + axis * all, count, parent.lower[axis]);
    copy_children(streams_.child_boxes.bytes() + (3 + axis) * all, count, parent.upper[axis]);
  }
  PackedDiscs packed;
  // A stream holds the low bytes of all planes, one plane after the other, then the high bytes.
  const auto copy_words = [&](const auto& stream, std::size_t plane, PackedDiscs::Words& words) {
    const std::byte* bytes = stream.bytes() + plane * all;
    copy_children(bytes, count, words.low);
    copy_children(bytes + stream.size(), count, words.high);
  };
  copy_words(streams_.child_normals, 0, packed.u);
  copy_words(streams_.child_normals, 1, packed.v);
  copy_words(streams_.child_slabs, 0, packed.slab_lower);
  copy_words(streams_.child_slabs, 1, packed.slab_upper);
  copy_words(streams_.child_radii, 0, packed.radius);
  const ChildFaults faults = unpack_discs(packed, static_cast<unsigned>(count), parent);
  if (faults.inverted_box) return "a child's box is not a box";
  if (faults.inverted_slab) return "a child's planes are crossed";
  return nullptr;
}

const char* PageDecoder::decode_child(Node& parent, std::size_t child, ChildKind kind) {
  if (info_.shape.moments)
    if (const char* fault = decode_moments(parent, child)) return fault;
  switch (kind) {
    case ChildKind::kNode:
      return link_to_node(parent, child);
    case ChildKind::kBlock:
      return link_to_block(parent, child);
    case ChildKind::kPage:
      return link_to_page(parent, child);
  }
  return "a child is of unknown kind";
}

const char* PageDecoder::decode_moments(Node& parent, std::size_t child) {
  constexpr const char* kOutOfRange = "a child's moments are out of range";
  const std::size_t count = streams_.head.child_count;
  Moments moments;
  for (std::size_t i = 0; i < 3; ++i) {
    moments.vector[i] = streams_.child_dipoles[i * count + next_child_];
    if (moments.vector[i] < -Moments::kDipoleSteps) return kOutOfRange;
  }
  for (std::size_t i = 0; i < 5; ++i) {
    moments.first[i] = streams_.child_quadrupoles[i * count + next_child_];
    if (moments.first[i] < -Moments::kQuadrupoleSteps) return kOutOfRange;
  }
  moments.area = streams_.child_areas[next_child_];
  moments.second = streams_.child_second_moments[next_child_];
  for (const ShortFloat value : {moments.area, moments.second})
    if (value < kMinShortFloat || value > kMaxShortFloat) return kOutOfRange;
  reinterpret_cast<NodeMoments*>(&parent + 1)->set(child, moments);
  return nullptr;
}

const char* PageDecoder::link_to_node(Node& parent, std::size_t child) {
  if (next_node_ >= streams_.head.node_count) return "its children do not add up";
  if (streams_.heights[next_node_] >= parent.height) return "a node is higher than its parent";
  const std::size_t record = to_slots_ ? node_slot(next_node_) : next_node_;
  parent.link[child] = links_.make(false, info_.page_number, static_cast<std::uint32_t>(record));
  node(next_node_)->box = child_box(parent, child);
  ++next_node_;
  return nullptr;
}

const char* PageDecoder::link_to_block(Node& parent, std::size_t child) {
  if (next_block_ >= streams_.head.block_count) return "its children do not add up";
  const std::size_t record = to_slots_ ? next_block_slot_ : next_block_;
  parent.link[child] = links_.make(true, info_.page_number, static_cast<std::uint32_t>(record));
  next_block_slot_ += block_slots(next_block_);
  ++next_block_;
  return nullptr;
}

const char* PageDecoder::link_to_page(Node& parent, std::size_t child) {
  if (next_page_link_ >= streams_.head.page_link_count) return "its page links do not add up";
  const StoredLink link = {streams_.linked_pages[next_page_link_],
                           streams_.linked_nodes[next_page_link_]};
  ++next_page_link_;
  if (link.page <= info_.page_number || link.page - info_.first_page >= info_.page_count)
    return "a link leads to a page that cannot be below it";
  if (link.record >= max_page_nodes(info_.page_bytes, info_.shape))
    return "a link leads to a node that no page can have";
  parent.link[child] = node_link(info_.page_bytes, info_.shape, link);
  return nullptr;
}

const char* PageDecoder::decode_blocks() {
  BlockDecoder blocks(streams_, info_.shape);
  if (const char* fault = blocks.start(frame_ + plan_.first_block_slot * kSlotBytes)) return fault;
  std::size_t slot = plan_.used_bytes / kSlotBytes;
  auto* slots = reinterpret_cast<std::uint16_t*>(frame_ + kSlotBytes);
  for (std::size_t i = streams_.head.block_count; i-- > 0;) {
    slot -= block_slots(i);
    slots[i] = static_cast<std::uint16_t>(slot);
    if (const char* fault = blocks.decode_last(frame_ + slot * kSlotBytes)) return fault;
  }
  return nullptr;
}

}  // namespace

Result<void> decode_page(std::span<const std::byte> raw, const PageInfo& info,
                         std::span<std::byte> frame) noexcept {
  assert(frame.size() == info.page_bytes);
  const char* fault = PageDecoder(info, frame).decode(raw);
  if (!fault) return {};
  return make_error(ErrorCode::kDamaged, info.page_number, Error::kNowhere,
                    "page %u is damaged: %s; build the file again", info.page_number, fault);
}

}  // namespace planetree::octree
