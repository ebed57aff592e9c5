#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "octree/builder/sort/triangle_runs.h"

namespace planetree::octree {

/// Maximum number of triangles of a chunk. A chunk is built in memory, by one thread. The tree
/// depends on this number.
inline constexpr std::uint64_t kChunkTriangles = 1 << 18;

/// A part of the model that is built at a time: a stretch of the Morton order.
struct Chunk {
  TriangleRuns::Cut from, to;
  std::uint64_t size = 0;  ///< number of triangles, at least 1
};

/// A node of the binary tree above the chunks, over chunks [begin, end). The binary trees within
/// chunks continue it.
struct ChunkNode {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  std::uint32_t left = 0;  ///< child nodes; 0 in a leaf, which is one chunk
  std::uint32_t right = 0;

  bool leaf() const { return left == 0; }
};

struct ChunkTree {
  std::vector<Chunk> chunks;     ///< in Morton order, those of strays last
  std::vector<ChunkNode> nodes;  ///< node 0 is the root; children come after their parents
  /// Node 0 has the core on its left and the strays on its right.
  bool parts_strays = false;
};

/// Parts the core from the strays. Splits both by the bits of Morton codes, and by triangle index
/// where all codes are equal, until no chunk has more triangles than the maximum. The chunks do not
/// depend on the runs.
///
/// has_strays  some triangle may be stray
Result<ChunkTree> cut_chunks(const TriangleRuns& runs, bool has_strays,
                             std::uint64_t most = kChunkTriangles);

}  // namespace planetree::octree
