#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "octree/builder/sort/chunks.h"
#include "octree/builder/tree/built_tree.h"
#include "storage/spill/spill_file.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {

/// The tree of a model of small patches, built as far as its file could be written.
struct PatchedTree {
  /// file  takes the patches' pages; must outlive this.
  explicit PatchedTree(const Soup& soup, std::uint64_t patch_triangles = 200,
                       std::uint32_t page_bytes = 4096, storage::SpillFile& file = spill_file());

  SampleMesh mesh;
  std::unique_ptr<TriangleRuns> runs;
  PatchTree above;
  BlockShape shape;
  std::vector<BuiltPatch> patches;
  std::unique_ptr<BuiltTree> tree;
};

}  // namespace planetree::octree
