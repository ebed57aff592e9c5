#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/page/frame.h"
#include "octree/page/page_streams.h"

/// The parts of unpacking blocks that take most of the time. They use vectors where the processor
/// has them; all instruction sets compute the same bits.
namespace planetree::octree {

/// Interleaves the coordinates of vertices.
///
/// byte_split  as stored: x of all vertices, then y, then z
/// vertices    capacity for x, y and z of each vertex in turn
/// return      false if a coordinate is not a number or is beyond kMaxCoordinate
bool unpack_vertices(const ByteSplit<float>& byte_split, float* vertices) noexcept;
bool unpack_vertices(const ByteSplit<double>& byte_split, double* vertices) noexcept;

/// The vertices of a block's corners, in the layouts of both forms of BlockHeader.
struct BlockCorners {
  std::uint8_t row[3][kMaxBlockTriangles];
  std::uint64_t packed[3];  ///< only if the block has up to 16 vertices
};

/// Unpacks the corners of a block. Lanes past the last triangle repeat its corners, so that kernels
/// need no mask.
///
/// stored          begins with the block's corners
/// triangle_count  1 to kMaxBlockTriangles
/// vertex_count    1 to kMaxBlockVertices
/// return          false if a corner is not below vertex_count
bool unpack_corners(std::span<const std::byte> stored, unsigned triangle_count,
                    unsigned vertex_count, BlockCorners& corners) noexcept;

/// Writes a block's vertices as rows of coordinates.
///
/// vertices  as unpack_vertices() writes them, with memory for one float behind them
/// indices   the block's vertices in `vertices`, then the first again up to `stride`
/// stride    a multiple of 8
/// rows      capacity for `stride` x, as many y, as many z; must not overlap `vertices` up to the
///           greatest index
/// return    the greatest squared distance from the first vertex
float unpack_rows(const float* vertices, const std::uint16_t* indices, unsigned stride,
                  float* rows) noexcept;

/// Position of a block's vertices among those of its page.
struct BlockVertices {
  std::size_t first_ref;  ///< index in the page's vertex refs of the block's first one
  unsigned ref_count;     ///< vertices that earlier blocks have, 0 to vertex_count
  std::size_t first_new;  ///< page index of the first new vertex, below 2^16; the others follow it
  unsigned vertex_count;  ///< 1 to kMaxBlockVertices
};

/// Writes the page indices of a block's vertices: those that earlier blocks have, then the new
/// ones, then the first again up to `stride`.
///
/// refs     contains all that the block refers to
/// stride   a multiple of 8
/// indices  capacity for `stride`
/// return   false if the indices that earlier blocks have do not ascend or are not below first_new
bool unpack_indices(const ByteSplit<std::uint16_t>& refs, const BlockVertices& block,
                    unsigned stride, std::uint16_t* indices) noexcept;

/// Writes the indices of a block's triangles, then the last one again up to kMaxBlockTriangles.
///
/// first       the first index; the others follow from the `count` - 1 steps from `first_step` on,
///             all of which are in `steps`
/// count       1 to kMaxBlockTriangles
/// ids         capacity for kMaxBlockTriangles
/// return      false if the indices do not ascend
bool unpack_ids(std::uint32_t first, const ByteSplit<std::uint32_t>& steps, std::size_t first_step,
                unsigned count, std::uint32_t* ids) noexcept;
bool unpack_ids(std::uint64_t first, const ByteSplit<std::uint64_t>& steps, std::size_t first_step,
                unsigned count, std::uint64_t* ids) noexcept;

}  // namespace planetree::octree
