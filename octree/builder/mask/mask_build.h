#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "octree/builder/mask/mask_sectors.h"
#include "octree/builder/mask/mask_tree.h"
#include "octree/builder/sort/triangle_runs.h"
#include "octree/builder/tree/built_tree.h"
#include "planetree/error.h"

namespace planetree::octree {

/// What the cells above a sector know of its mask: the root.
struct SectorRoot {
  MaskEntry entry;
  std::optional<SpecialCell> special;

  static SectorRoot of(const MaskTree& mask, std::size_t sector);
};

/// Receives the mask of a sector, with its root as the first entry; on any thread.
using SectorSink =
    std::function<Result<void>(std::size_t sector, const MaskTree& mask, const SectorRoot& root)>;

/// Returns the root of a sector whose mask was built before, or null.
using KnownRoots = std::function<const SectorRoot*(std::size_t sector)>;

/// Builds the mask of a model, sector by sector. The winding number is known outside of the model's
/// box. It is carried from there to the least corner of every sector, by the crossings of the
/// sectors' edges.
///
/// sectors  those of the model, with all triangles of the surface and of its caps added.
/// trees    the blocks that cells list are their blocks; without a surface, cells list none.
/// known    `take` is not called for sectors whose roots are known.
/// return   the cells above the sectors, and the sectors' roots.
/// errors   those of reading spilled data, of TreeFrames, and of `take`.
/// Uses the calling thread's TBB arena; the result depends on the model alone.
///
/// source  white, black and grey cells: "Out-of-core real-time haptic interaction on very large
///         models", section 3.1; winding numbers at corners, in place of parity along a line, are
///         ours.
Result<MaskTree> build_mask(const MaskSectors& sectors, const TriangleRuns& runs,
                            const BuiltTrees& trees, const KnownRoots& known,
                            const SectorSink& take);

}  // namespace planetree::octree
