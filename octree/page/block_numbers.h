#pragma once

#include <cstddef>
#include <cstdint>

#include "octree/page/frame.h"
#include "octree/page/raw_streams.h"

/// The ascending numbers that a page stores as differences, a block's at a time: many at once
/// where the processor can, the same on every instruction set.
namespace planetree::octree {

/// Where a block's vertices are among those of its page.
struct BlockVertices {
  std::size_t first_ref;  ///< in the page's vertex refs: of vertices that blocks before have
  unsigned ref_count;     ///< up to vertex_count
  std::size_t first_new;  ///< of its other vertices, which follow upon each other; below 2^16
  unsigned vertex_count;  ///< 1 to kMaxBlockVertices
};

/// Writes the places of a block's vertices, those of blocks before first, then that of its first
/// vertex again, up to `stride`, a multiple of 8.
///
/// refs    has all that the block names.
/// places  room for `stride`.
/// return  false if those of blocks before do not ascend or are not below first_new.
bool unpack_indices(const ByteSplit<std::uint16_t>& refs, const BlockVertices& block,
                    unsigned stride, std::uint16_t* indices) noexcept;

/// Writes the indices of a block's triangles, the last one again up to kMaxBlockTriangles.
///
/// first       index; the others by the `count` - 1 steps from `first_step` on, which there are.
/// count       1 to kMaxBlockTriangles.
/// return      false if they do not ascend.
bool unpack_ids(std::uint32_t first, const ByteSplit<std::uint32_t>& steps, std::size_t first_step,
                unsigned count, std::uint32_t* ids) noexcept;
bool unpack_ids(std::uint64_t first, const ByteSplit<std::uint64_t>& steps, std::size_t first_step,
                unsigned count, std::uint64_t* ids) noexcept;

}  // namespace planetree::octree
