#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "octree/geometry/child_bounds.h"
#include "octree/geometry/tree_limits.h"
#include "octree/geometry/triangle_distance.h"
#include "octree/page/link.h"

/// The serving layout: a decoded distance page in its frame. It is never stored;
/// format-spec/v1/spec.md, "Distance page", specifies the stored form.
///
///     slot 0            FrameHeader
///     slot 1 ...        slot of each block, 16 bits each; 0 behind the last block (BlockTable)
///     first node slot   nodes, 5 slots each, subtree roots first, then breadth first; 7 slots if
///                       each node is followed by its moments (octree/page/moments.h)
///     ...               blocks, in the order in which their parents link to them
///
/// A slot is 64 bytes, so that a link addresses a record in few bits and every record begins on a
/// cache line.
namespace planetree::octree {

struct FrameHeader {
  std::uint32_t page_number;
  std::uint32_t used_bytes;
  std::uint64_t octcode;
  std::uint32_t ordinal;
  std::uint16_t node_count;
  std::uint16_t block_count;
  std::uint16_t root_count;  ///< nodes at the front that are roots of subtrees
  std::uint16_t first_node_slot;
  std::uint16_t first_block_slot;
  std::uint16_t page_link_count;  ///< links to other pages
  std::uint8_t reserved[32];
};
static_assert(sizeof(FrameHeader) == kSlotBytes);

/// Up to eight children, field by field, so that one vector holds one field of all of them. Boxes
/// and planes are relative to the model's centre. The first two cache lines suffice for queries
/// nearby. The last three hold the discs and are read only where discs can pay (see
/// octree/traversal/bounds.h).
struct alignas(kSlotBytes) Node {
  FloatBox box;              ///< the node's own box, which contains those of its children
  float step[3];             ///< unit of the children's sides, see box_step()
  float gate;                ///< discs are evaluated where this node's own squared bound is larger
  std::uint8_t child_count;  ///< 1 to 8
  std::uint8_t height;       ///< maximum count of nodes on a path down to a block, this included
  std::uint8_t reserved[6];
  std::uint8_t lower[3][kFanOut];  ///< steps as in PackedChild; 0 for unused children
  std::uint8_t upper[3][kFanOut];
  std::uint32_t link[kFanOut];
  float normal[3][kFanOut];   ///< slab normal, unit length to a few ulps
  float slab_lower[kFanOut];  ///< minimum of normal . (x - box centre) over the surface points x
  float slab_upper[kFanOut];
  float radius[kFanOut];  ///< maximum distance of a surface point from the slab's axis
};
static_assert(sizeof(Node) == 5 * kSlotBytes);
static_assert(offsetof(Node, normal) == 2 * kSlotBytes);
inline constexpr unsigned kNodeSlots = sizeof(Node) / kSlotBytes;
inline constexpr unsigned kNearNodeSlots = offsetof(Node, normal) / kSlotBytes;  ///< without discs
inline constexpr unsigned kMomentSlots = 2;

/// Head of a triangle block. These arrays follow it, each on a slot of its own:
///
///     float  local[3][stride]     float32 models: the exact vertices
///                                 float64 models: vertices minus vertex 0, rounded
///     double exact[3][stride]     float64 models only
///     uint32 or uint64 ids[16]    triangle indices, ascending; not in compact blocks
///
/// The head of a compact block contains its ids, and its corners in four bits each. In most float32
/// models nine blocks in ten are compact.
struct alignas(kSlotBytes) BlockHeader {
  static constexpr unsigned kMaxCompactVertices = 16;
  static constexpr std::uint32_t kMaxCompactSpan = 0xffff;  ///< maximum of last index - first index

  float extent;                 ///< no vertex is farther from vertex 0
  std::uint8_t triangle_count;  ///< 1 to 16
  std::uint8_t form;            ///< vertex count, 1 to 48; kHeightField, kCompact
  // Compact blocks only; others have corner_row() here.
  std::uint16_t id_step[kMaxBlockTriangles - 1];  ///< index - first_id, from the second triangle on
  std::uint32_t first_id;
  std::uint64_t packed_corners[3];  ///< by corner: vertex of each triangle's corner, 4 bits from
                                    ///< corner_bit() on

  static constexpr std::uint8_t kHeightField = 0x40;  ///< see octree/nearest/height_field.h
  static constexpr std::uint8_t kCompact = 0x80;

  unsigned vertex_count() const { return form & 0x3fU; }
  bool is_height_field() const { return (form & kHeightField) != 0; }
  bool compact() const { return (form & kCompact) != 0; }
  /// Returns the length of a coordinate's row: 16, 24, 32 or 48.
  unsigned stride() const;

  /// Returns the lowest bit of a triangle's corner in packed_corners. In this order, a register
  /// with packed_corners in each pair of lanes yields the corners of successive triangles by
  /// shifts.
  static constexpr unsigned corner_bit(unsigned triangle) {
    return 32 * (triangle % 2) + 4 * (triangle / 2);
  }
  /// Returns the vertex of corner `corner` of each triangle: the last bytes of the head. Not in
  /// compact blocks.
  const std::uint8_t* corner_row(std::size_t corner) const {
    return reinterpret_cast<const std::uint8_t*>(this + 1) - kMaxBlockTriangles * (3 - corner);
  }
  std::uint8_t* corner_row(std::size_t corner) {
    return reinterpret_cast<std::uint8_t*>(this + 1) - kMaxBlockTriangles * (3 - corner);
  }
  /// Returns the vertices of one triangle.
  std::array<unsigned, 3> corners(unsigned triangle) const {
    if (!compact())
      return {corner_row(0)[triangle], corner_row(1)[triangle], corner_row(2)[triangle]};
    const auto at = [&](std::uint64_t packed) {
      return static_cast<unsigned>(packed >> corner_bit(triangle)) & 15U;
    };
    return {at(packed_corners[0]), at(packed_corners[1]), at(packed_corners[2])};
  }
  /// Returns whether all triangles have the same corners in the same order.
  bool repeats_one_triangle() const {
    if (vertex_count() > 3) return false;
    if (compact()) {
      // In the lanes behind the last triangle too, which repeat it.
      const auto same = [](std::uint64_t packed) {
        return packed == (packed & 15U) * 0x1111'1111'1111'1111U;
      };
      return same(packed_corners[0]) && same(packed_corners[1]) && same(packed_corners[2]);
    }
    for (unsigned i = 1; i < triangle_count; ++i)
      if (corners(i) != corners(0)) return false;
    return true;
  }
};
static_assert(sizeof(BlockHeader) == kSlotBytes);
static_assert(offsetof(BlockHeader, packed_corners) == 40);

/// Layout of the records of one file, which follows from the file's header.
struct BlockShape {
  bool float64 = false;
  bool wide_ids = false;
  bool moments = false;  ///< moments follow each node: the surface is not watertight
  LinkTarget links = LinkTarget::kSlot;  ///< what the links of nodes lead to

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
  /// Returns whether a block is compact. `span` is its last index less the first.
  constexpr bool is_compact(unsigned vertex_count, std::uint64_t span) const {
    return may_be_compact(vertex_count) && span <= BlockHeader::kMaxCompactSpan;
  }
  /// Returns whether a block is compact if its indices are close enough.
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

static_assert(BlockShape{}.slots(1, true) == kMinBlockSlots);

/// Returns a number that the nodes of a page do not exceed.
constexpr std::uint32_t max_page_nodes(std::uint32_t page_bytes, const BlockShape& shape) {
  const auto slots = static_cast<std::uint32_t>(page_bytes / kSlotBytes);
  return (slots - frame_head_slots(page_bytes)) / shape.node_slots();
}

/// Returns the link to a node whose number is below max_page_nodes().
constexpr std::uint32_t node_link(std::uint32_t page_bytes, const BlockShape& shape,
                                  StoredLink node) {
  const LinkFormat links(page_bytes, shape.links);
  if (shape.links == LinkTarget::kNumber) return links.make(false, node.page, node.record);
  return links.make(false, node.page,
                    frame_head_slots(page_bytes) + node.record * shape.node_slots());
}

/// Returns the decoded box of one of a node's children.
inline FloatBox child_box(const Node& node, std::size_t child) {
  return unpack_box(node.box, {node.lower[0][child], node.lower[1][child], node.lower[2][child]},
                    {node.upper[0][child], node.upper[1][child], node.upper[2][child]});
}

/// Read access to a triangle block in its frame. Vertices and indices are exact.
class BlockView {
 public:
  BlockView(const std::byte* record, const BlockShape& shape)
      : BlockView(*reinterpret_cast<const BlockHeader*>(record), shape) {}
  /// The rest of the block follows `header` in memory.
  BlockView(const BlockHeader& header, const BlockShape& shape) : header_(header), shape_(shape) {}

  const BlockHeader& header() const { return header_; }
  /// Returns the number of slots that the record takes.
  unsigned slots() const { return shape_.slots(header_.vertex_count(), header_.compact()); }
  unsigned triangle_count() const { return header_.triangle_count; }

  Point vertex(unsigned index) const {
    return shape_.float64 ? vertex_of(exact_vertices(), index)
                          : vertex_of(at<float>(kSlotBytes), index);
  }

  /// Returns the exact vertices, header().stride() of each coordinate; null in float64 models.
  const float* float_vertices() const { return shape_.float64 ? nullptr : at<float>(kSlotBytes); }

  Triangle triangle(unsigned index) const {
    return shape_.float64 ? triangle_of(exact_vertices(), index)
                          : triangle_of(at<float>(kSlotBytes), index);
  }

  std::uint64_t id(unsigned index) const {
    if (header_.compact()) return header_.first_id + (index > 0 ? header_.id_step[index - 1] : 0U);
    const std::size_t offset = shape_.id_offset(header_.stride());
    return shape_.wide_ids ? at<std::uint64_t>(offset)[index] : at<std::uint32_t>(offset)[index];
  }

 private:
  const double* exact_vertices() const { return at<double>(shape_.exact_offset(header_.stride())); }

  template <class T>
  Point vertex_of(const T* rows, unsigned index) const {
    const unsigned stride = header_.stride();
    return {rows[index], rows[stride + index], rows[2 * stride + index]};
  }
  template <class T>
  Triangle triangle_of(const T* rows, unsigned index) const {
    const auto corners = header_.corners(index);
    return {vertex_of(rows, corners[0]), vertex_of(rows, corners[1]), vertex_of(rows, corners[2])};
  }
  template <class T>
  const T* at(std::size_t offset) const {
    return reinterpret_cast<const T*>(reinterpret_cast<const std::byte*>(&header_) + offset);
  }

  const BlockHeader& header_;
  const BlockShape& shape_;
};

}  // namespace planetree::octree
