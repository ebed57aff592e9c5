#pragma once

#include <cstddef>
#include <cstdint>

#include "octree/page/frame.h"
#include "octree/page/raw_streams.h"

/// Unpacks ascending numbers that a page stores as differences, one block at a time. Uses vectors
/// where the processor has them; all instruction sets return the same numbers.
namespace planetree::octree {

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
