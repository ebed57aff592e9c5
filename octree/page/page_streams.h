#pragma once

#include <cstddef>
#include <cstdint>

/// The head of a page's raw bytes, as format-spec/v1/spec.md states it in
/// "Distance page". Behind it come the streams, in the order of the spec, each
/// without padding:
///
///   root boxes       float32 x 6 a root node: lower, upper
///   child counts     u8 a node
///   heights          u8 a node
///   child kinds      u16 a node, 2 bits a child (ChildKind)
///   child boxes      6 planes of u8: lower x y z, upper x y z
///   child normals    2 planes of i16: u, v
///   child slabs      2 planes of i16: lower, upper
///   child radii      u16
///   child dipoles         3 planes of i16: x, y, z            } of models that are
///   child quadrupoles     5 planes of i8: xx, yy, xy, yz, zx  } not watertight only
///   child areas           u16, a ShortFloat                   } (octree/page/moments.h)
///   child second moments  u16, a ShortFloat                   }
///   page links       u32 a child of kind kPage
///   triangle counts  u8 a block, and kHeightFieldBit, kCompactBit
///   vertex counts    u8 a block
///   new counts       u8 a block: how many of its vertices the page has not had
///   vertex refs      u16 a vertex the page has had; ascending, as differences
///   corners          4, 5 or 6 bits each, by block, whole bytes a block
///   vertices         float32 or float64 x 3 a new vertex
///   first ids        u32 or u64 a block
///   id steps         u32 or u64 a further triangle: difference to the one before
///
/// "Plane" and every stream wider than a byte is byte-stream split: all first
/// bytes, then all second bytes, and so on.
namespace planetree::octree {

enum class ChildKind : std::uint8_t {
  kNode = 0,   ///< the next node of this page
  kBlock = 1,  ///< the next block of this page
  kPage = 2,   ///< a node or block of another page, by a link of its own
};

/// Of a block's count of triangles: it is in a sheet (BlockHeader::is_height_field()).
inline constexpr std::uint8_t kHeightFieldBit = 0x80;
/// And it is compact: of up to 16 vertices, its indices no more than 65,535 above the first.
inline constexpr std::uint8_t kCompactBit = 0x40;
/// What is left of the count.
inline constexpr std::uint8_t kCountBits = 0x3f;

struct PageHead {
  std::uint32_t page_number;
  std::uint32_t ordinal;
  std::uint64_t octcode;
  std::uint16_t node_count;
  std::uint16_t block_count;
  std::uint16_t root_node_count;   ///< the first nodes are roots of subtrees
  std::uint16_t root_block_count;  ///< so are the first blocks
  std::uint16_t child_count;       ///< of all nodes
  std::uint16_t page_link_count;
  std::uint16_t vertex_count;  ///< distinct in this page
  std::uint16_t vertex_ref_count;
  std::uint16_t triangle_count;
  std::uint16_t reserved[3];  ///< zero
};
static_assert(sizeof(PageHead) == 40);

/// Bits of one corner index in a block of so many vertices.
constexpr unsigned corner_bits(unsigned vertex_count) {
  return vertex_count <= 16 ? 4 : vertex_count <= 32 ? 5 : 6;
}

/// Bytes of all corner indices of a block.
constexpr std::size_t corner_bytes(unsigned triangle_count, unsigned vertex_count) {
  return (std::size_t{3} * triangle_count * corner_bits(vertex_count) + 7) / 8;
}

}  // namespace planetree::octree
