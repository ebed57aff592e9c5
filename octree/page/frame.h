#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "octree/geometry/float_box.h"
#include "octree/geometry/tree_limits.h"

/// The serving layout: what a decoded page looks like in its frame. Nothing
/// here is ever stored; format-spec/v1/spec.md, "Distance page", states what is.
///
///   slot 0            FrameHeader
///   slot 1 ...        block starts, one bit a slot
///   first node slot   nodes, 5 slots each, subtree roots first, then breadth first; 7 where
///                     each is followed by its moments (octree/page/moments.h)
///   ...               blocks, in the order their parents name them
///
/// A slot is 64 bytes, so that a link addresses a record in few bits and every
/// record begins on a cache line.
namespace planetree::octree {

inline constexpr std::size_t kSlotBytes = 64;

struct FrameHeader {
  std::uint32_t page_number;
  std::uint32_t used_bytes;
  std::uint64_t octcode;
  std::uint32_t ordinal;
  std::uint16_t node_count;
  std::uint16_t block_count;
  std::uint16_t root_node_count;
  std::uint16_t root_block_count;
  std::uint16_t first_node_slot;
  std::uint16_t first_block_slot;
  std::uint16_t page_link_count;  ///< to other pages
  std::uint8_t reserved[30];
};
static_assert(sizeof(FrameHeader) == kSlotBytes);

/// Up to eight children, field by field, so that one vector holds one field of
/// all of them. Boxes and planes are relative to the model's centre. The first
/// two lines answer near queries; the last three, the discs, are read only
/// where they can pay (see octree/traversal/bounds.h).
struct alignas(kSlotBytes) Node {
  FloatBox box;              ///< its own, of which its children's are parts
  float step[3];             ///< that their sides are counted in: box_step()
  float gate;                ///< discs pay where this node's own bound^2 is larger
  std::uint8_t child_count;  ///< 1 to 8
  std::uint8_t height;       ///< nodes below and including this one on the longest path
  std::uint8_t reserved[6];
  std::uint8_t lower[3][kFanOut];  ///< as in PackedChild; of unused children 0
  std::uint8_t upper[3][kFanOut];
  std::uint32_t link[kFanOut];
  float normal[3][kFanOut];   ///< of the slab; unit to a few ulps
  float slab_lower[kFanOut];  ///< normal . (x - box centre) of all surface points x
  float slab_upper[kFanOut];
  float radius[kFanOut];  ///< greatest distance of a surface point from the slab's axis
};
static_assert(sizeof(Node) == 5 * kSlotBytes);
static_assert(offsetof(Node, normal) == 2 * kSlotBytes);
inline constexpr unsigned kNodeSlots = sizeof(Node) / kSlotBytes;
inline constexpr unsigned kNearNodeSlots = offsetof(Node, normal) / kSlotBytes;  ///< no discs
inline constexpr unsigned kMomentSlots = 2;

/// Head of a triangle block. Behind it, each array on a slot of its own:
///   float  local[3][stride]     float32 models: the exact vertices
///                               float64 models: vertices minus `origin`, rounded
///   double exact[3][stride]     float64 models only
///   uint32 or uint64 ids[16]    triangle indices, ascending; not of compact blocks
/// A compact block has its ids in its head, and four bits a corner: of most float32 models nine
/// blocks in ten are.
struct alignas(kSlotBytes) BlockHeader {
  static constexpr unsigned kMaxCompactVertices = 16;
  static constexpr std::uint32_t kMaxCompactSpan = 0xffff;  ///< last index less the first

  float extent;                 ///< at least the distance of any vertex from vertex 0
  std::uint8_t triangle_count;  ///< 1 to 16
  std::uint8_t form;            ///< vertices, 1 to 48; kHeightField, kCompact
  // Of compact blocks; others have corner_row() here.
  std::uint16_t id_step[kMaxBlockTriangles - 1];  ///< index less the first, from the second on
  std::uint32_t first_id;
  std::uint64_t packed_corners[3];  ///< vertex of each corner, by corner: bits at corner_bit()

  static constexpr std::uint8_t kHeightField =
      0x40;  ///< known to be in one (octree/nearest/height_field.h)
  static constexpr std::uint8_t kCompact = 0x80;

  unsigned vertex_count() const { return form & 0x3fU; }
  bool is_height_field() const { return (form & kHeightField) != 0; }
  bool compact() const { return (form & kCompact) != 0; }
  /// From one coordinate of the vertices to the next: 16, 24, 32 or 48.
  unsigned stride() const;

  /// Where a triangle's corner begins among the bits of packed_corners: so that a register with
  /// these in each pair of lanes needs but shift them.
  static constexpr unsigned corner_bit(unsigned triangle) {
    return 32 * (triangle % 2) + 4 * (triangle / 2);
  }
  /// The vertex of each triangle's corner, of a block that is not compact: the head's last bytes.
  const std::uint8_t* corner_row(std::size_t corner) const {
    return reinterpret_cast<const std::uint8_t*>(this + 1) - kMaxBlockTriangles * (3 - corner);
  }
  std::uint8_t* corner_row(std::size_t corner) {
    return reinterpret_cast<std::uint8_t*>(this + 1) - kMaxBlockTriangles * (3 - corner);
  }
  /// Of one triangle.
  std::array<unsigned, 3> corners(unsigned triangle) const {
    if (!compact())
      return {corner_row(0)[triangle], corner_row(1)[triangle], corner_row(2)[triangle]};
    const auto at = [&](std::uint64_t packed) {
      return static_cast<unsigned>(packed >> corner_bit(triangle)) & 15U;
    };
    return {at(packed_corners[0]), at(packed_corners[1]), at(packed_corners[2])};
  }
};
static_assert(sizeof(BlockHeader) == kSlotBytes);
static_assert(offsetof(BlockHeader, packed_corners) == 40);

/// How records of one file are laid out; a function of three header fields.
struct BlockShape {
  bool float64 = false;
  bool wide_ids = false;
  bool moments = false;  ///< nodes are followed by theirs: the surface is not watertight

  constexpr unsigned node_slots() const { return kNodeSlots + (moments ? kMomentSlots : 0); }

  static constexpr unsigned stride(unsigned vertex_count) {
    return vertex_count <= 16 ? 16 : vertex_count <= 24 ? 24 : vertex_count <= 32 ? 32 : 48;
  }
  constexpr std::size_t exact_offset(unsigned stride) const {
    return kSlotBytes + align(3 * stride * sizeof(float));
  }
  constexpr std::size_t id_offset(unsigned stride) const {
    return exact_offset(stride) + (float64 ? align(3 * stride * sizeof(double)) : 0);
  }
  /// Whether a block is compact, of which the last index is so much above the first.
  constexpr bool is_compact(unsigned vertex_count, std::uint64_t span) const {
    return may_be_compact(vertex_count) && span <= BlockHeader::kMaxCompactSpan;
  }
  /// Whether it is if its indices are near enough to each other.
  constexpr bool may_be_compact(unsigned vertex_count) const {
    return !float64 && !wide_ids && vertex_count <= BlockHeader::kMaxCompactVertices;
  }
  constexpr unsigned slots(unsigned vertex_count, bool compact) const {
    const std::size_t ids = compact ? 0 : kMaxBlockTriangles * (wide_ids ? 8 : 4);
    return static_cast<unsigned>((id_offset(stride(vertex_count)) + ids) / kSlotBytes);
  }

 private:
  static constexpr std::size_t align(std::size_t bytes) {
    return (bytes + kSlotBytes - 1) / kSlotBytes * kSlotBytes;
  }
};

inline unsigned BlockHeader::stride() const { return BlockShape::stride(vertex_count()); }

/// A child's address in 32 bits: [leaf 1][page 31 - s][slot s], where s is
/// log2(page bytes / 64).
class LinkFormat {
 public:
  explicit constexpr LinkFormat(std::uint32_t page_bytes)
      : slot_bits_(static_cast<unsigned>(std::countr_zero(page_bytes)) - 6) {}

  static constexpr std::uint32_t kLeafBit = std::uint32_t{1} << 31;
  static constexpr bool is_leaf(std::uint32_t link) { return (link & kLeafBit) != 0; }
  constexpr std::uint32_t page(std::uint32_t link) const {
    return (link & ~kLeafBit) >> slot_bits_;
  }
  constexpr std::uint32_t slot(std::uint32_t link) const { return link & slot_mask(); }
  constexpr std::uint32_t make(bool leaf, std::uint32_t page, std::uint32_t slot) const {
    return (leaf ? kLeafBit : 0) | page << slot_bits_ | slot;
  }
  constexpr std::uint32_t max_pages() const { return std::uint32_t{1} << (31 - slot_bits_); }

 private:
  constexpr std::uint32_t slot_mask() const { return (std::uint32_t{1} << slot_bits_) - 1; }
  unsigned slot_bits_;
};

/// Slots taken by the frame header and the bits that say where blocks start.
constexpr unsigned frame_head_slots(std::uint32_t page_bytes) {
  const std::size_t bit_bytes = page_bytes / kSlotBytes / 8;
  return static_cast<unsigned>(1 + (bit_bytes + kSlotBytes - 1) / kSlotBytes);
}

}  // namespace planetree::octree
