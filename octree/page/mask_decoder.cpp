#include "octree/page/page_decoder.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>

#include "octree/geometry/strict_math.h"
#include "octree/geometry/tree_limits.h"
#include "octree/page/frame.h"
#include "octree/page/mask_frame.h"
#include "octree/page/mask_streams.h"

namespace planetree::octree {
namespace {

class MaskDecoder {
 public:
  MaskDecoder(const PageInfo& info, std::span<std::byte> frame)
      : info_(info),
        links_(info.page_bytes),
        block_links_(LinkFormat::numbered(info.page_bytes)),
        frame_(frame.data()) {}

  const char* decode(std::span<const std::byte> raw) {
    if (const char* fault = streams_.read(raw, info_.shape.float64)) return fault;
    if (const char* fault = fault_of_key(head(), info_)) return fault;
    if (head().ordinal != 0) return "its ordinal is not 0";
    if (const char* fault = write_header()) return fault;
    next_family_ = head().root_count;
    for (std::size_t i = 0; i < head().record_count; ++i)
      if (const char* fault = decode_record(i)) return fault;
    return check_sums();
  }

 private:
  const MaskPageHead& head() const { return streams_.head; }
  const char* write_header();
  const char* count_lists(std::size_t& slots) const;
  const char* decode_record(std::size_t index);
  const char* decode_node(MaskNode& node, bool has_link);
  const char* link_family(MaskNode& node);
  const char* link_other_page(MaskNode& node);
  const char* decode_plain(MaskCorners& corners);
  const char* decode_corners(MaskCorners& corners);
  const char* decode_special(MaskSpecial& special);
  const char* decode_plane();
  const char* decode_listed(MaskListed& listed);
  const char* decode_slab(std::size_t at, std::byte* slab) const;
  const char* decode_list(std::byte* octants, std::byte* links, unsigned count);
  const char* check_sums() const;

  static bool is_leaf(std::uint8_t kind) {
    return kind > static_cast<int>(MaskKind::kNodeWithLink);
  }

  const PageInfo& info_;
  MaskLinkFormat links_;
  LinkFormat block_links_;
  std::byte* frame_;
  MaskStreams streams_;
  std::size_t first_record_slot_ = 0;
  std::size_t first_plane_slot_ = 0;
  std::size_t next_family_ = 0;
  std::size_t next_node_ = 0;
  std::size_t next_link_ = 0;
  std::size_t next_plain_ = 0;
  std::size_t next_corners_ = 0;
  std::size_t next_special_ = 0;
  std::size_t next_plane_ = 0;
  std::size_t next_listed_ = 0;
  std::size_t next_list_slot_ = 0;
  std::size_t next_block_ = 0;
};

const char* MaskDecoder::write_header() {
  first_record_slot_ = mask_head_slots(info_.page_bytes);
  first_plane_slot_ = first_record_slot_ + head().record_count;
  next_list_slot_ = first_plane_slot_ + kPlaneSlots * head().plane_count;
  std::size_t end = next_list_slot_;
  if (const char* fault = count_lists(end)) return fault;
  if (end * kMaskSlotBytes > info_.page_bytes) return "its records do not fit a page";
  std::memset(frame_, 0, first_record_slot_ * kMaskSlotBytes);
  MaskHeader header{};
  header.page_number = head().page_number;
  header.ordinal = head().ordinal;
  header.octcode = head().octcode;
  header.record_count = head().record_count;
  header.root_count = head().root_count;
  header.first_record_slot = static_cast<std::uint16_t>(first_record_slot_);
  header.first_plane_slot = static_cast<std::uint16_t>(first_plane_slot_);
  header.page_link_count = head().page_link_count;
  std::memcpy(frame_, &header, sizeof header);
  return nullptr;
}

// Checks the lists' counts and adds the slots of all lists to `slots`.
const char* MaskDecoder::count_lists(std::size_t& slots) const {
  std::size_t blocks = 0;
  for (std::size_t i = 0; i < head().listed_count; ++i) {
    const unsigned count = streams_.block_counts[i];
    if (count == 0 || count > kMaxListed) return "a list's count of blocks is out of range";
    slots += list_slots(count);
    blocks += count;
  }
  return blocks == head().block_link_count ? nullptr : "its lists do not add up";
}

const char* MaskDecoder::decode_record(std::size_t index) {
  if (index >= next_family_) return "a record has no parent";
  const std::size_t slot = first_record_slot_ + index;
  std::byte* record = frame_ + slot * kMaskSlotBytes;
  const auto kind = static_cast<MaskKind>(streams_.kinds[index]);
  switch (kind) {
    case MaskKind::kNode:
    case MaskKind::kNodeWithLink: {
      auto* nodes = reinterpret_cast<std::uint64_t*>(frame_ + sizeof(MaskHeader));
      nodes[slot / 64] |= std::uint64_t{1} << slot % 64;
      return decode_node(*reinterpret_cast<MaskNode*>(record), kind == MaskKind::kNodeWithLink);
    }
    case MaskKind::kPlainCorners:
      return decode_plain(*reinterpret_cast<MaskCorners*>(record));
    case MaskKind::kCorners:
      return decode_corners(*reinterpret_cast<MaskCorners*>(record));
    case MaskKind::kSpecial:
      return decode_special(*reinterpret_cast<MaskSpecial*>(record));
    case MaskKind::kListed:
      return decode_listed(*reinterpret_cast<MaskListed*>(record));
  }
  return "a record is of unknown kind";
}

const char* MaskDecoder::decode_node(MaskNode& node, bool has_link) {
  if (next_node_ == head().node_count) return "the counts of records do not add up";
  const std::size_t at = next_node_++;
  const unsigned grey = streams_.grey[at], leaf = streams_.leaf[at], black = streams_.black[at],
                 inverted = streams_.inverted[at];
  if ((leaf & ~grey) != 0 || (grey & black) != 0 || (grey & inverted) != 0 ||
      (black & inverted) != 0)
    return "an octant has two colours";
  node = {0, 0, streams_.grey[at], static_cast<std::uint8_t>(leaf | black), streams_.inverted[at]};
  if (has_link) return link_other_page(node);
  return node.grey == 0 ? nullptr : link_family(node);
}

const char* MaskDecoder::link_family(MaskNode& node) {
  const std::size_t first = next_family_;
  next_family_ += static_cast<unsigned>(std::popcount(node.grey));
  if (next_family_ > head().record_count) return "its families do not add up";
  std::size_t member = first;
  for (unsigned octant = 0; octant < 8; ++octant) {
    if (!node.is_grey(octant)) continue;
    if (is_leaf(streams_.kinds[member++]) != node.is_leaf(octant))
      return "a record is not of the kind its parent says";
  }
  node.set_family(links_.make(info_.page_number - info_.first_page,
                              static_cast<std::uint32_t>(first_record_slot_ + first)));
  return nullptr;
}

const char* MaskDecoder::link_other_page(MaskNode& node) {
  if (node.grey == 0 || next_link_ == head().page_link_count) return "its page links do not add up";
  const StoredLink link = {streams_.linked_pages[next_link_], streams_.linked_records[next_link_]};
  ++next_link_;
  const std::size_t slot = first_record_slot_ + link.record;
  const std::size_t end = slot + static_cast<std::size_t>(std::popcount(node.grey));
  if (link.page <= info_.page_number - info_.first_page || link.page >= info_.page_count ||
      end * kMaskSlotBytes > info_.page_bytes)
    return "a link leads to a page that cannot be below it";
  node.set_family(links_.make(link.page, static_cast<std::uint32_t>(slot)));
  return nullptr;
}

const char* MaskDecoder::decode_plain(MaskCorners& corners) {
  if (next_plain_ == head().plain_count) return "the counts of records do not add up";
  const std::uint8_t bits = streams_.plain_corners[next_plain_++];
  for (unsigned corner = 0; corner < 8; ++corner)
    corners[corner] = static_cast<std::int8_t>(bits >> corner & 1);
  return nullptr;
}

const char* MaskDecoder::decode_corners(MaskCorners& corners) {
  if (next_corners_ == head().corners_count) return "the counts of records do not add up";
  const std::size_t at = 8 * next_corners_++;
  for (unsigned corner = 0; corner < 8; ++corner) corners[corner] = streams_.corners[at + corner];
  if (std::count(corners.begin(), corners.end(), kListedTag) != 0)
    return "a corner's winding number is out of range";
  const auto uncounted = std::count(corners.begin(), corners.end(), kUncounted);
  return uncounted == 0 || uncounted == 8 ? nullptr : "a corner of a cell is not counted";
}

const char* MaskDecoder::decode_special(MaskSpecial& special) {
  if (next_special_ == head().special_count) return "the counts of records do not add up";
  const std::size_t at = next_special_++;
  special.tag = kUncounted;
  special.plane_count = streams_.plane_counts[at];
  special.behind = streams_.behind[at];
  special.beyond = streams_.beyond[at];
  special.plane_slot = static_cast<std::uint32_t>(first_plane_slot_ + kPlaneSlots * next_plane_);
  if (special.plane_count == 0 || special.plane_count > kMaxPlanes)
    return "a special cell's planes are out of range";
  if (special.behind == kUncounted || special.beyond == kUncounted ||
      special.behind == special.beyond)
    return "a special cell has no two sides";
  for (unsigned i = 0; i < special.plane_count; ++i)
    if (const char* fault = decode_plane()) return fault;
  return nullptr;
}

const char* MaskDecoder::decode_plane() {
  if (next_plane_ == head().plane_count) return "its planes do not add up";
  auto* plane = reinterpret_cast<double*>(frame_ + first_plane_slot_ * kMaskSlotBytes) +
                kPlaneSlots * next_plane_;
  for (std::size_t i = 0; i < kPlaneSlots; ++i) {
    plane[i] = streams_.plane_coordinate(kPlaneSlots * next_plane_ + i);
    if (!(std::fabs(plane[i]) < kMaxPlaneCoordinate)) return "a plane is out of range";
  }
  ++next_plane_;
  return nullptr;
}

const char* MaskDecoder::decode_listed(MaskListed& listed) {
  if (next_listed_ == head().listed_count) return "the counts of records do not add up";
  const std::size_t at = next_listed_++;
  listed = {kListedTag, streams_.block_counts[at], streams_.least[at], streams_.higher[at],
            static_cast<std::uint32_t>(next_list_slot_)};
  if (listed.least <= kListedTag || listed.least == std::numeric_limits<std::int8_t>::max())
    return "a corner's winding number is out of range";
  std::byte* const octants = frame_ + next_list_slot_ * kMaskSlotBytes;
  next_list_slot_ += list_slots(listed.block_count);
  std::byte* const slab = octants + list_octant_slots(listed.block_count) * kMaskSlotBytes;
  // Clears the last slot of the octants and of the list, which may be written in part.
  std::memset(slab - kMaskSlotBytes, 0, kMaskSlotBytes);
  std::memset(frame_ + (next_list_slot_ - 1) * kMaskSlotBytes, 0, kMaskSlotBytes);
  if (const char* fault = decode_slab(at, slab)) return fault;
  return decode_list(octants, slab + sizeof(std::uint32_t), listed.block_count);
}

const char* MaskDecoder::decode_slab(std::size_t at, std::byte* slab) const {
  CellSlab found;
  found.direction = streams_.slab_directions[at];
  found.lower = streams_.slab_lowers[at];
  found.upper = streams_.slab_uppers[at];
  if (!found.direction_is_valid()) return "a slab's direction is out of range";
  if (found.lower > found.upper) return "a slab's planes are the wrong way round";
  const std::uint32_t word = found.word();
  std::memcpy(slab, &word, sizeof word);
  return nullptr;
}

// Works on copies of members, because the compiler assumes that writing a byte may change members.
const char* MaskDecoder::decode_list(std::byte* octants, std::byte* links, unsigned count) {
  const ByteSplit<std::uint8_t> all_octants = streams_.block_octants;
  const ByteSplit<std::uint32_t> all_pages = streams_.block_pages;
  const ByteSplit<std::uint16_t> all_numbers = streams_.block_numbers;
  const LinkFormat format = block_links_;
  const std::uint32_t page_count = info_.tree_pages;
  const std::uint32_t max_blocks = max_page_blocks(info_.page_bytes);
  const std::size_t first = next_block_;
  next_block_ += count;
  bool all_touch = true, all_lead = true, ascend = true;
  std::uint32_t before = 0;
  for (unsigned i = 0; i < count; ++i) {
    const std::uint8_t touched = all_octants[first + i];
    const StoredLink block = {all_pages[first + i], all_numbers[first + i]};
    const std::uint32_t link = format.make_block(block);
    all_touch &= touched != 0;
    all_lead &= block.page < page_count;
    all_lead &= block.record < max_blocks;
    ascend &= link > before;
    before = link;
    std::memcpy(octants + i, &touched, sizeof touched);
    std::memcpy(links + i * sizeof link, &link, sizeof link);
  }
  if (!all_touch) return "a listed block has no octant";
  if (!all_lead) return "a list has a link that leads to no block";
  return ascend ? nullptr : "the blocks of a list are not in order";
}

const char* MaskDecoder::check_sums() const {
  if (next_family_ != head().record_count) return "its families do not add up";
  if (next_link_ != head().page_link_count) return "its page links do not add up";
  if (next_plane_ != head().plane_count) return "its planes do not add up";
  return nullptr;
}

}  // namespace

Result<void> decode_mask_page(std::span<const std::byte> raw, const PageInfo& info,
                              std::span<std::byte> frame) noexcept {
  assert(frame.size() == info.page_bytes);
  const char* fault = MaskDecoder(info, frame).decode(raw);
  if (!fault) return {};
  return make_error(ErrorCode::kDamaged, info.page_number, Error::kNowhere,
                    "mask page %u is damaged: %s; build the file again", info.page_number, fault);
}

}  // namespace planetree::octree
