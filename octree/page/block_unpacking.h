#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/page/frame.h"
#include "octree/page/raw_streams.h"

/// What unpacking a page's blocks spends its time on, many values at once where the processor
/// can. The same bits on every instruction set.
namespace planetree::octree {

/// Coordinates of vertices are at most so large, for then no square and no product of squares
/// overflows, wherever vertices go from here. An honest model's are below 2^55.
inline constexpr double kFarthestVertex = 0x1p60;

/// Brings the coordinates of each vertex together.
///
/// shuffled  as stored: x of all vertices, then y, then z.
/// vertices  room for x, y and z of each vertex in turn.
/// return    false if one is not a number, or beyond kFarthestVertex.
bool unpack_vertices(const ByteSplit<float>& byte_split, float* vertices) noexcept;
bool unpack_vertices(const ByteSplit<double>& byte_split, double* vertices) noexcept;

/// The vertices of a block's corners, as either form of a block's head has them.
struct BlockCorners {
  std::uint8_t row[3][kMaxBlockTriangles];
  std::uint64_t packed[3];  ///< of a block with more than 16 vertices: nothing of use
};

/// Unpacks the corners of a block. Those of lanes past the last triangle are the last triangle's,
/// so that kernels need no mask.
///
/// stored          begins with the block's corners.
/// triangle_count  1 to kMaxBlockTriangles; vertex_count  1 to kMaxBlockVertices.
/// return          false if one is not below vertex_count.
bool unpack_corners(std::span<const std::byte> stored, unsigned triangle_count,
                    unsigned vertex_count, BlockCorners& corners) noexcept;

/// Lays vertices of a page out as a block has them.
///
/// vertices  as unpack_vertices() left them, and room for one float behind.
/// places    of the block's vertices among these, then the first again, up to the stride.
/// stride    a multiple of 8.
/// rows      room for `stride` x, as many y, as many z; apart from `vertices` up to the last place.
/// return    the greatest square of a distance from the first.
float unpack_rows(const float* vertices, const std::uint16_t* indices, unsigned stride,
                  float* rows) noexcept;

}  // namespace planetree::octree
