#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "octree/builder/sort/chunks.h"
#include "octree/builder/tree/built_tree.h"
#include "storage/spill/spill_file.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {

/// The tree of a model in small chunks, built up to the writing of its file.
struct ChunkedTree {
  /// file  spill file for the chunks' pages; must outlive this.
  explicit ChunkedTree(const Soup& soup, std::uint64_t chunk_triangles = 200,
                       std::uint32_t page_bytes = 4096, storage::SpillFile& file = spill_file());

  SampleMesh mesh;
  std::unique_ptr<TriangleRuns> runs;
  ChunkTree above;
  BlockShape shape;
  std::vector<BuiltChunk> chunks;
  std::unique_ptr<BuiltTree> tree;
};

}  // namespace planetree::octree
