#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "octree/builder/sort/triangle_runs.h"

namespace planetree::octree {

/// Most triangles of a patch. A patch is built in memory, by one thread; the tree does depend
/// on this number.
inline constexpr std::uint64_t kChunkTriangles = 1 << 18;

/// A part of the model that is built at a time: a stretch of the Morton curve.
struct Chunk {
  TriangleRuns::Cut from, to;
  std::uint64_t size = 0;  ///< triangles, at least 1
};

/// A node above the patches: a binary tree as that in them is, over patches [begin, end).
struct ChunkNode {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  std::uint32_t left = 0;  ///< child nodes; 0 in a leaf, which is a patch, for node 0 is the root
  std::uint32_t right = 0;

  bool leaf() const { return left == 0; }
};

struct ChunkTree {
  std::vector<Chunk> chunks;     ///< in Morton order
  std::vector<ChunkNode> nodes;  ///< children come after their parents
};

/// Splits a model by the bits of Morton codes, and by number where all codes are the same,
/// until at most `most` triangles are left: the same patches however the runs are.
Result<ChunkTree> cut_chunks(const TriangleRuns& runs, std::uint64_t most = kChunkTriangles);

}  // namespace planetree::octree
