#pragma once

#include <cstdint>
#include <vector>

#include "octree/builder/sort/triangles.h"
#include "octree/builder/tree/moment_sums.h"
#include "octree/builder/tree/page_plan.h"
#include "octree/builder/tree/spilled_page.h"
#include "octree/geometry/child_bounds.h"
#include "octree/page/frame.h"
#include "planetree/error.h"
#include "storage/spill/spill_file.h"

namespace planetree::octree {

/// Result of building a chunk, from which the tree above it is made.
struct BuiltChunk {
  std::vector<SpilledPage>
      pages;                ///< in the order of their keys; the root is record 0 of the first
  std::uint8_t height = 0;  ///< height of the root; 0 if it is a block
  std::uint64_t node_count = 0;
  std::uint64_t block_count = 0;
  std::uint64_t min_code = 0, greatest_code = 0;  ///< Morton codes
  FloatBox box;                       ///< box of the root, relative to the model's centre
  std::vector<FloatBox> boxes_below;  ///< boxes two levels below the root
  Point area = Point::Zero();         ///< sum of the triangles' area vectors
  SurfaceSums sums;                   ///< about the centre of `box`; 0 if the model is watertight
};

/// Builds the tree of a chunk and spills its pages.
///
/// is_whole   the chunk is the whole tree, which may be one block; else its root is a node.
/// triangles  those of the chunk, sorted; model frame.
/// centre     centre of the model.
/// threads    any number, each with its own chunk.
/// errors     those of plan_pages() and SpillFile.
Result<BuiltChunk> build_chunk(const Triangles& triangles, bool is_whole, const Point& centre,
                               const BlockShape& shape, std::uint32_t page_bytes,
                               storage::SpillFile& file);

}  // namespace planetree::octree
