#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "octree/geometry/cell_slab.h"

/// The mask tells which side the cells of the octree are on. White cells are outside of the solid,
/// black and inverted ones inside, and the surface may pass through grey ones. Only watertight
/// models have a mask: the winding numbers of other models are not constant off the surface.
///
/// This is the layout of a decoded mask page; format-spec/v1/spec.md, "Mask page", specifies the
/// stored form.
///
///     slot 0                 MaskHeader
///     slot 8 ...             which records are nodes, one bit a slot
///     first record slot ...  records, a slot each: roots first, then breadth first
///     ...                    planes of special cells
///     ...                    lists of blocks
///
/// A slot is 8 bytes. The grey children of a node lie side by side, in the order of their octants.
/// One link leads to all of them, as a family.
///
/// source  "Out-of-core real-time haptic interaction on very large models", section 3.1
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
  std::uint16_t page_link_count;  ///< links to other pages
  std::uint8_t reserved[38];
};
static_assert(sizeof(MaskHeader) == 64);

/// Returns whether the record in a slot of a frame is a node.
inline bool is_mask_node(const std::byte* frame, std::uint32_t slot) {
  const auto* nodes = reinterpret_cast<const std::uint64_t*>(frame + sizeof(MaskHeader));
  return (nodes[slot / 64] >> slot % 64 & 1) != 0;
}

/// A link to a family, in 40 bits. See MaskLinkFormat.
using MaskLink = std::uint64_t;

/// A divided grey cell. An octant without a bit in the masks is white.
struct MaskNode {
  std::uint32_t family_low;    ///< link to the first grey child; 0 if there is none
  std::uint8_t family_high;    ///< bits 32 to 39 of this link
  std::uint8_t grey;           ///< mask of octants that the surface may pass through
  std::uint8_t leaf_or_black;  ///< of grey octants: not divided further; of others: inside, of
                               ///< positive winding number
  std::uint8_t inverted;       ///< mask of octants inside, of negative winding number

  constexpr MaskLink family() const { return MaskLink{family_high} << 32 | family_low; }
  constexpr void set_family(MaskLink link) {
    family_low = static_cast<std::uint32_t>(link);
    family_high = static_cast<std::uint8_t>(link >> 32);
  }
  constexpr bool is_grey(unsigned octant) const { return (grey >> octant & 1) != 0; }
  /// Whether a grey octant is not divided further.
  constexpr bool is_leaf(unsigned octant) const { return (leaf_or_black >> octant & 1) != 0; }
  /// The sign of the winding number in an octant that is not grey.
  constexpr int winding(unsigned octant) const {
    return (leaf_or_black >> octant & 1) - (inverted >> octant & 1);
  }
  constexpr unsigned leaf() const { return leaf_or_black & grey; }
  constexpr unsigned black() const { return leaf_or_black & ~unsigned{grey}; }
};
static_assert(sizeof(MaskNode) == kMaskSlotBytes);

/// Replaces the winding numbers of a cell if they do not fit a byte or one is unknown.
inline constexpr std::int8_t kUncounted = -128;

/// First byte of a MaskListed; no number in MaskCorners has this value.
inline constexpr std::int8_t kListedTag = -127;

/// Number of octants in a set. A table, because a lookup counts at every node and the processors
/// that the library is built for may lack an instruction for it.
inline constexpr auto kOctantCounts = [] {
  std::array<std::uint8_t, 256> counts{};
  for (unsigned set = 1; set < 256; ++set)
    counts[set] = static_cast<std::uint8_t>(counts[set / 2] + set % 2);
  return counts;
}();
constexpr unsigned count_octants(unsigned set) { return kOctantCounts[set]; }

/// A grey leaf: the winding numbers at its corners, each of them perturbed (see
/// octree/geometry/predicates.h). Either all are kUncounted or none is, and none is kListedTag.
using MaskCorners = std::array<std::int8_t, 8>;
static_assert(sizeof(MaskCorners) == kMaskSlotBytes);

inline constexpr unsigned kMaxPlanes = 4;

/// A special cell. The surface within it is the boundary of the space behind up to four planes.
/// Each plane is given by a triangle that lies in it.
///
/// source  section 3.2 of the same paper, convex and concave configurations; one record covers
///         both, since either side may be the outside of the solid
struct MaskSpecial {
  std::int8_t tag;           ///< kUncounted; in MaskCorners the next byte would be kUncounted too
  std::uint8_t plane_count;  ///< 1 to kMaxPlanes
  std::int8_t behind;        ///< winding number of points behind or on all planes
  std::int8_t beyond;        ///< winding number of other points, not `behind`
  std::uint32_t plane_slot;  ///< slot in this page of the planes, 9 doubles each
};
static_assert(sizeof(MaskSpecial) == kMaskSlotBytes);

inline constexpr unsigned kPlaneSlots = 9;

inline constexpr unsigned kMaxListed = 16;

/// A listed cell: its corners have one of two winding numbers, and the blocks with triangles in it
/// are known.
struct MaskListed {
  std::int8_t tag;           ///< kListedTag
  std::uint8_t block_count;  ///< 1 to kMaxListed
  std::int8_t least;         ///< winding number of the corners not in `higher`
  std::uint8_t higher;       ///< mask of corners whose winding number is `least` + 1
  std::uint32_t list_slot;   ///< slot in this page of the list: for each block a u8, the octants
                             ///< that its triangles touch; then, from the next whole slot on, the
                             ///< cell's slab, a u32, and the numbered link of each block, a u32
};
static_assert(sizeof(MaskListed) == kMaskSlotBytes);

/// Returns the winding number at a corner.
constexpr int corner_number(const MaskListed& listed, unsigned corner) {
  return listed.least + (listed.higher >> corner & 1);
}

/// Number of slots of a list's octants, and of the whole list.
constexpr unsigned list_octant_slots(unsigned block_count) { return (block_count + 7) / 8; }
constexpr unsigned list_slots(unsigned block_count) {
  return list_octant_slots(block_count) + (block_count + 2) / 2;
}

/// A copy of a cell's list of blocks, as numbered links (LinkFormat), and of its slab.
struct MaskBlocks {
  std::uint8_t count = 0;
  alignas(kMaskSlotBytes)
      std::array<std::uint8_t, kMaxListed> octants;  ///< the first `count` are set, as in `links`
  std::array<std::uint32_t, kMaxListed> links;
  CellSlab slab;

  /// Writes the links of the blocks that touch an octant to the front of `found`. Returns their
  /// number.
  unsigned in_octant(unsigned octant, std::array<std::uint32_t, kMaxListed>& found) const {
    unsigned size = 0;
    for (unsigned i = 0; i < count; ++i) {
      found[size] = links[i];
      size += octants[i] >> octant & 1U;
    }
    return size;
  }
};

/// Copies the list of a record from its frame.
inline void copy_list(const std::byte* frame, const MaskListed& listed, MaskBlocks& blocks) {
  const std::byte* list = frame + std::size_t{listed.list_slot} * kMaskSlotBytes;
  blocks.count = listed.block_count;
  // Copies whole slots; both arrays of octants end on one.
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

/// Layout of a link to a family: [page within the mask 40 - s][slot s]; s is log2(page bytes / 8).
class MaskLinkFormat {
 public:
  explicit constexpr MaskLinkFormat(std::uint32_t page_bytes)
      : slot_bits_(static_cast<unsigned>(std::countr_zero(page_bytes)) - 3) {}

  constexpr std::uint32_t page(MaskLink link) const {
    return static_cast<std::uint32_t>(link >> slot_bits_);
  }
  constexpr std::uint32_t slot(MaskLink link) const {
    return static_cast<std::uint32_t>(link) & ((std::uint32_t{1} << slot_bits_) - 1);
  }
  constexpr MaskLink make(std::uint32_t page, std::uint32_t slot) const {
    return MaskLink{page} << slot_bits_ | slot;
  }
  constexpr std::uint64_t max_pages() const { return std::uint64_t{1} << (40 - slot_bits_); }
  /// Returns the number of slots of a page.
  constexpr std::uint32_t slots() const { return std::uint32_t{1} << slot_bits_; }

 private:
  unsigned slot_bits_;
};

/// Returns the slots of the header and of the bits that mark nodes.
constexpr unsigned mask_head_slots(std::uint32_t page_bytes) {
  return static_cast<unsigned>(sizeof(MaskHeader) / kMaskSlotBytes +
                               page_bytes / kMaskSlotBytes / 64);
}

}  // namespace planetree::octree
