#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/page/byte_split.h"
#include "octree/page/frame.h"

/// The head of a distance page's raw bytes, specified in format-spec/v1/spec.md, "Distance page".
/// These streams follow it, in the order of the specification and without padding:
///
///     root boxes            float32 x 6 a root node: lower, upper
///     child counts          u8 a node
///     heights               u8 a node
///     child kinds           u16 a node, 2 bits a child (ChildKind)
///     child boxes           6 planes of u8: lower x y z, upper x y z
///     child normals         2 planes of i16: u, v
///     child slabs           2 planes of i16: lower, upper
///     child radii           u16
///     child dipoles         3 planes of i16: x, y, z            } only in cap pages
///     child quadrupoles     5 planes of i8: xx, yy, xy, yz, zx  } (octree/page/moments.h)
///     child areas           u16, a ShortFloat                   }
///     child second moments  u16, a ShortFloat                   }
///     linked pages          u32 a child of kind kPage
///     linked nodes          u16 a child of kind kPage: number in that page
///     triangle counts       u8 a block, with kHeightFieldBit and kCompactBit
///     vertex counts         u8 a block
///     new counts            u8 a block: vertices that no earlier block of the page has
///     vertex refs           u16 a vertex that an earlier block has; ascending, as differences
///     corners               4, 5 or 6 bits each, by block, whole bytes a block
///     vertices              float32 or float64 x 3 a new vertex
///     first ids             u32 or u64 a block
///     id steps              u32 or u64 a further triangle: difference to the one before
///
/// A plane holds one component of all children. Every stream wider than a byte is byte-stream
/// split: all first bytes, then all second bytes, and so on.
namespace planetree::octree {

enum class ChildKind : std::uint8_t {
  kNode = 0,   ///< the next node of this page
  kBlock = 1,  ///< the next block of this page
  kPage = 2,   ///< a node of another page, given by a link
};

/// Bit of a stored triangle count: the block is in a height field (BlockHeader::is_height_field()).
inline constexpr std::uint8_t kHeightFieldBit = 0x80;
/// Bit of a stored triangle count: the block is compact. It has up to 16 vertices, and no index
/// exceeds the first by more than 65,535.
inline constexpr std::uint8_t kCompactBit = 0x40;
/// The triangle count itself.
inline constexpr std::uint8_t kCountBits = 0x3f;

struct PageHead {
  std::uint32_t page_number;
  std::uint32_t ordinal;
  std::uint64_t octcode;
  std::uint16_t node_count;
  std::uint16_t block_count;
  std::uint16_t root_count;       ///< nodes at the front that are roots of subtrees
  std::uint16_t child_count;      ///< children of all nodes
  std::uint16_t page_link_count;  ///< children in other pages
  std::uint16_t vertex_count;     ///< distinct vertices of the page
  std::uint16_t vertex_ref_count;
  std::uint16_t triangle_count;
  std::uint16_t reserved[4];  ///< zero
};
static_assert(sizeof(PageHead) == 40);

/// Returns the bits of one corner in a block with `vertex_count` vertices.
constexpr unsigned corner_bits(unsigned vertex_count) {
  return vertex_count <= 16 ? 4 : vertex_count <= 32 ? 5 : 6;
}

/// Returns the bytes of all corners of a block.
constexpr std::size_t corner_bytes(unsigned triangle_count, unsigned vertex_count) {
  return (std::size_t{3} * triangle_count * corner_bits(vertex_count) + 7) / 8;
}

/// The streams of a distance page. Their lengths have been checked, their contents have not.
struct RawStreams {
  PageHead head{};
  ByteSplit<float> root_boxes;
  ByteSplit<std::uint8_t> child_counts, heights;
  ByteSplit<std::uint16_t> child_kinds;
  ByteSplit<std::uint8_t> child_boxes;  ///< 6 planes of child_count
  ByteSplit<std::int16_t> child_normals, child_slabs;
  ByteSplit<std::uint16_t> child_radii;
  ByteSplit<std::int16_t> child_dipoles;     ///< 3 planes of child_count, or none
  ByteSplit<std::int8_t> child_quadrupoles;  ///< 5 planes
  ByteSplit<std::uint16_t> child_areas, child_second_moments;
  ByteSplit<std::uint32_t> linked_pages;
  ByteSplit<std::uint16_t> linked_nodes;
  ByteSplit<std::uint8_t> triangle_counts;  ///< with kHeightFieldBit, kCompactBit
  ByteSplit<std::uint8_t> vertex_counts, new_counts;
  ByteSplit<std::uint16_t> vertex_refs;
  std::span<const std::byte> corners;
  ByteSplit<float> vertices32;
  ByteSplit<double> vertices64;
  ByteSplit<std::uint32_t> first_ids32, id_steps32;
  ByteSplit<std::uint64_t> first_ids64, id_steps64;

  std::uint8_t triangle_count(std::size_t block) const {
    return triangle_counts[block] & kCountBits;
  }
  bool is_height_field(std::size_t block) const {
    return (triangle_counts[block] & kHeightFieldBit) != 0;
  }
  bool compact(std::size_t block) const { return (triangle_counts[block] & kCompactBit) != 0; }

  /// Locates the streams in `raw`, which must outlive this object. Returns null, or a fault.
  const char* read(std::span<const std::byte> raw, const BlockShape& shape) noexcept;
};

}  // namespace planetree::octree
