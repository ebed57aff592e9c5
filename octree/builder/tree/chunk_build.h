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

/// A patch that was built: what the tree above it is made from.
struct BuiltChunk {
  std::vector<SpilledPage> pages;  ///< in the order of their keys
  std::uint32_t root_link = 0;     ///< the page by its place in `pages`
  std::uint8_t height = 0;         ///< of its root; 0 if that is a block
  std::uint64_t node_count = 0;
  std::uint64_t block_count = 0;
  std::uint64_t min_code = 0, greatest_code = 0;
  FloatBox box;                       ///< the root's, relative to the model's centre
  std::vector<FloatBox> boxes_below;  ///< two levels below the root
  Point area = Point::Zero();         ///< sum of area vectors
  SurfaceSums sums;                   ///< about the centre of `box`; of open models only
};

/// Builds the tree of a patch and puts its pages away.
///
/// triangles  of the patch, in order; model frame.
/// centre     of the model.
/// threads    any number, with patches of their own.
/// errors     those of plan_pages() and SpillFile.
Result<BuiltChunk> build_chunk(const Triangles& triangles, const Point& centre,
                               const BlockShape& shape, std::uint32_t page_bytes,
                               storage::SpillFile& file);

}  // namespace planetree::octree
