#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "octree/builder/job/model_frame.h"
#include "octree/builder/mask/mask_sectors.h"
#include "octree/builder/sort/chunks.h"
#include "octree/builder/sort/triangle_runs.h"
#include "octree/builder/surface/cap_chain.h"
#include "octree/builder/surface/region_cut.h"
#include "octree/builder/tree/built_tree.h"
#include "octree/builder/tree/chunk_build.h"
#include "planetree/error.h"
#include "storage/file/file_layout.h"
#include "storage/spill/spill_file.h"

namespace planetree::octree {

/// The caps of a surface, in the form in which a later build resumes them.
struct CapWork {
  std::uint64_t count = 0;
  double area = 0;                         ///< sum, model frame
  std::vector<TriangleRuns::Extent> runs;  ///< none of them is in memory
};

/// Makes the caps of a surface and the tree of them, whose nodes have moments. The caps of a
/// watertight surface are none, and there is no tree. Nor is there one without close() and
/// resume(). threads  one at a time.
class CapTree {
 public:
  /// frame, shape  those of the surface; must outlive this.
  /// held_bytes    maximum of caps in memory.
  /// file          receives the others, and `pages` the pages; both must outlive this.
  CapTree(const ModelFrame& frame, const BlockShape& shape, std::uint32_t page_bytes,
          std::uint64_t held_bytes, storage::SpillFile& file, storage::SpillFile& pages);

  /// Makes the caps. Counts the crossings of the caps with the segment of `cut`.
  /// errors  those of CapChain::close(); kBadArgument: more caps than indices of 32 bits can count.
  Result<void> close(CapChain& boundary, RegionCut& cut);
  /// Takes the caps of an earlier build.
  void resume(const CapWork& work);
  /// Returns the caps for a later build. None may be in memory.
  CapWork work() const { return {count_, area_, runs_.extents()}; }

  std::uint64_t count() const { return count_; }
  /// The caps, or null if there are none.
  const TriangleRuns* runs() const { return count_ > 0 ? &runs_ : nullptr; }

  /// Builds the tree, and adds the caps to the sectors of the mask.
  /// max_triangles  maximum of a chunk.
  /// errors         those of cut_chunks(), MaskSectors::add() and build_chunk().
  Result<void> build(MaskSectors& sectors, std::uint64_t max_triangles);
  /// Numbers the pages, the first of which is page `first_page` of the file.
  /// errors  those of BuiltTree::check().
  Result<void> number_pages(std::uint32_t first_page);

  /// The tree, after number_pages(); null if there are no caps.
  const BuiltTree* tree() const { return tree_ ? &*tree_ : nullptr; }
  /// Writes the figures of the caps into the model record, after number_pages().
  void describe(storage::ModelRecord& model) const;

 private:
  Result<void> add(const Triangle& cap, RegionCut& cut);

  const ModelFrame& frame_;
  const std::uint32_t page_bytes_;
  storage::SpillFile& pages_;
  BlockShape shape_;
  TriangleRuns runs_;
  Triangles batch_;
  std::uint64_t count_ = 0;
  double area_ = 0;
  ChunkTree above_;
  std::vector<BuiltChunk> chunks_;
  std::optional<BuiltTree> tree_;
};

}  // namespace planetree::octree
