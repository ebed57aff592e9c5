#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/page/frame.h"
#include "octree/page/raw_streams.h"

/// The parts of unpacking blocks that take most of the time. They use vectors where the processor
/// has them; all instruction sets compute the same bits.
namespace planetree::octree {

/// Maximum magnitude of a vertex coordinate. Within it, no square and no product of squares
/// overflows in any later computation. Coordinates that the builder writes are below 2^55.
inline constexpr double kFarthestVertex = 0x1p60;

/// Interleaves the coordinates of vertices.
///
/// byte_split  as stored: x of all vertices, then y, then z
/// vertices    capacity for x, y and z of each vertex in turn
/// return      false if a coordinate is not a number or is beyond kFarthestVertex
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

}  // namespace planetree::octree
