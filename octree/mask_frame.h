#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

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
  std::uint8_t reserved[40];
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
/// moved by the infinitesimal step of predicates.h. All are kUncounted or none.
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

constexpr bool is_special(const MaskCorners& record) {
  return record[0] == kUncounted && record[1] != kUncounted;
}

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

 private:
  unsigned slot_bits_;
};

/// Slots of the header and of the bits behind it.
constexpr unsigned mask_head_slots(std::uint32_t page_bytes) {
  return static_cast<unsigned>(sizeof(MaskHeader) / kMaskSlotBytes +
                               page_bytes / kMaskSlotBytes / 64);
}

}  // namespace planetree::octree
