#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "octree/geometry/cell_slab.h"

/// The mask says which side the cells of the octree are on: white cells are
/// outside of the solid, black ones inside, and the surface passes through grey
/// ones ("Out-of-core real-time haptic interaction on very large models",
/// section 3.1). Only watertight models have one: elsewhere winding numbers are
/// not constant off the surface.
///
/// This is the layout of a decoded mask page; format-spec/v1/spec.md, "Mask
/// page", states what is stored.
///
///   slot 0                 MaskHeader
///   slot 8 ...             which records are nodes, one bit a slot
///   first record slot ...  records, a slot each: roots first, then breadth first
///   ...                    planes of special cells
///   ...                    lists of blocks
///
/// A slot is 8 bytes. The grey children of a node lie side by side, in the order
/// of their octants, and are linked to as one family.
namespace planetree::octree {

inline constexpr std::size_t kMaskSlotBytes = 8;

struct MaskHeader {
  std::uint32_t page_number;
  std::uint32_t ordinal;
  std::uint64_t octcode;
  std::uint16_t record_count;
  std::uint16_t root_count;
  std::uint16_t first_record_slot;
  std::uint16_t first_plane_slot;
  std::uint16_t page_link_count;  ///< to other pages
  std::uint8_t reserved[38];
};
static_assert(sizeof(MaskHeader) == 64);

/// Whether the record in a slot of a frame is a node.
inline bool is_mask_node(const std::byte* frame, std::uint32_t slot) {
  const auto* nodes = reinterpret_cast<const std::uint64_t*>(frame + sizeof(MaskHeader));
  return (nodes[slot / 64] >> slot % 64 & 1) != 0;
}

/// An octant of which all four bits are 0 is white.
struct MaskNode {
  std::uint32_t family;   ///< link to the first grey child; 0 if there is none
  std::uint8_t grey;      ///< octants the surface may pass through
  std::uint8_t leaf;      ///< of those, the ones that are not divided further
  std::uint8_t black;     ///< octants inside, of positive winding number
  std::uint8_t inverted;  ///< octants inside, of negative winding number
};
static_assert(sizeof(MaskNode) == kMaskSlotBytes);

/// Winding numbers do not fit in a byte, or some corner is not known.
inline constexpr std::int8_t kUncounted = -128;

/// What tells a MaskListed from winding numbers.
inline constexpr std::int8_t kListedTag = -127;

/// How many octants a set has. The processors we build for may lack an instruction for it,
/// and a lookup asks at every node.
inline constexpr auto kOctantCounts = [] {
  std::array<std::uint8_t, 256> counts{};
  for (unsigned set = 1; set < 256; ++set)
    counts[set] = static_cast<std::uint8_t>(counts[set / 2] + set % 2);
  return counts;
}();
constexpr unsigned count_octants(unsigned set) { return kOctantCounts[set]; }

/// A grey cell that is not divided: the winding numbers at its corners, each
/// moved by the infinitesimal step of predicates.h. All are kUncounted or none, and
/// none is kListedTag.
using MaskCorners = std::array<std::int8_t, 8>;
static_assert(sizeof(MaskCorners) == kMaskSlotBytes);

inline constexpr unsigned kMaxPlanes = 4;

/// A special cell: within it the surface is the boundary of what is behind a
/// few planes, each given by a triangle in it (section 3.2: convex and concave
/// configurations; that any of them may be the solid's outside is how the two
/// become one).
struct MaskSpecial {
  std::int8_t tag;           ///< kUncounted, which a second corner's byte would repeat
  std::uint8_t plane_count;  ///< 1 to kMaxPlanes
  std::int8_t behind;        ///< winding number behind or on all planes
  std::int8_t beyond;        ///< winding number elsewhere; another one
  std::uint32_t plane_slot;  ///< in this page: planes, 9 doubles each
};
static_assert(sizeof(MaskSpecial) == kMaskSlotBytes);

inline constexpr unsigned kPlaneSlots = 9;

inline constexpr unsigned kMaxListed = 16;

/// A cell whose corners have one of two winding numbers, and of which it is known what blocks of
/// the tree have triangles in it.
struct MaskListed {
  std::int8_t tag;           ///< kListedTag
  std::uint8_t block_count;  ///< 1 to kMaxListed
  std::int8_t least;         ///< winding number of the corners that are not `higher`
  std::uint8_t higher;       ///< corners whose winding number is `least` + 1
  std::uint32_t list_slot;   ///< in this page: for each block a u8, the octants of the cell that
                             ///< its triangles touch; from the next whole slot on the cell's slab,
                             ///< a u32, and for each block its link, a u32
};
static_assert(sizeof(MaskListed) == kMaskSlotBytes);

/// The winding number at one of its corners.
constexpr int corner_of(const MaskListed& listed, unsigned corner) {
  return listed.least + (listed.higher >> corner & 1);
}

/// Slots of the octants of a list, and of all of it.
constexpr unsigned list_octant_slots(unsigned block_count) { return (block_count + 7) / 8; }
constexpr unsigned list_slots(unsigned block_count) {
  return list_octant_slots(block_count) + (block_count + 2) / 2;
}

/// A list of blocks by itself, and the slab of its cell.
struct MaskBlocks {
  std::uint8_t count = 0;
  alignas(kMaskSlotBytes)
      std::array<std::uint8_t, kMaxListed> octants;  ///< the first `count`, as the links
  std::array<std::uint32_t, kMaxListed> links;
  CellSlab slab;

  /// Puts together the links of those that touch an octant. Returns how many.
  unsigned in_octant(unsigned octant, std::array<std::uint32_t, kMaxListed>& found) const {
    unsigned size = 0;
    for (unsigned i = 0; i < count; ++i) {
      found[size] = links[i];
      size += octants[i] >> octant & 1U;
    }
    return size;
  }
};

/// The list of a record that a frame holds.
inline void copy_list(const std::byte* frame, const MaskListed& listed, MaskBlocks& blocks) {
  const std::byte* list = frame + std::size_t{listed.list_slot} * kMaskSlotBytes;
  blocks.count = listed.block_count;
  // By slots, of which the octants have whole ones.
  auto* octants = reinterpret_cast<std::byte*>(blocks.octants.data());
  for (unsigned slots = list_octant_slots(blocks.count); slots > 0; --slots) {
    std::memcpy(octants, list, kMaskSlotBytes);
    octants += kMaskSlotBytes;
    list += kMaskSlotBytes;
  }
  std::uint32_t slab;
  std::memcpy(&slab, list, sizeof slab);
  blocks.slab = CellSlab::of_word(slab);
  list += sizeof slab;
  unsigned i = 0;
  for (; i + 1 < blocks.count; i += 2) std::memcpy(&blocks.links[i], list + 4 * i, 8);
  if (i < blocks.count) std::memcpy(&blocks.links[i], list + 4 * i, 4);
}

constexpr bool is_special(const MaskCorners& record) {
  return record[0] == kUncounted && record[1] != kUncounted;
}
constexpr bool is_listed(const MaskCorners& record) { return record[0] == kListedTag; }

/// A family's address: [page within the mask 32 - s][slot s], where s is
/// log2(page bytes / 8).
class MaskLinkFormat {
 public:
  explicit constexpr MaskLinkFormat(std::uint32_t page_bytes)
      : slot_bits_(static_cast<unsigned>(std::countr_zero(page_bytes)) - 3) {}

  constexpr std::uint32_t page(std::uint32_t link) const { return link >> slot_bits_; }
  constexpr std::uint32_t slot(std::uint32_t link) const {
    return link & ((std::uint32_t{1} << slot_bits_) - 1);
  }
  constexpr std::uint32_t make(std::uint32_t page, std::uint32_t slot) const {
    return page << slot_bits_ | slot;
  }
  constexpr std::uint64_t max_pages() const { return std::uint64_t{1} << (32 - slot_bits_); }
  /// Of a page.
  constexpr std::uint32_t slots() const { return std::uint32_t{1} << slot_bits_; }

 private:
  unsigned slot_bits_;
};

/// Slots of the header and of the bits behind it.
constexpr unsigned mask_head_slots(std::uint32_t page_bytes) {
  return static_cast<unsigned>(sizeof(MaskHeader) / kMaskSlotBytes +
                               page_bytes / kMaskSlotBytes / 64);
}

}  // namespace planetree::octree
