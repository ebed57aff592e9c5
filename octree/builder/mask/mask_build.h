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

/// What the cells above know of a region's mask: its root.
struct SectorRoot {
  MaskEntry entry;
  std::optional<SpecialCell> special;

  static SectorRoot of(const MaskTree& mask, std::size_t sector);
};

/// Takes the mask of a region, its root the first entry; on any thread.
using SectorSink =
    std::function<Result<void>(std::size_t sector, const MaskTree& mask, const SectorRoot& root)>;

/// The root of a region whose mask was built before; null: it was not.
using KnownRoots = std::function<const SectorRoot*(std::size_t sector)>;

/// Makes the mask of a model, region by region: winding numbers are known outside the model's
/// box, and carried from there to the least corner of every region by the crossings of regions'
/// edges.
///
/// regions  of a watertight model, all of whose triangles were added.
/// tree     whose blocks cells list; null: they list none.
/// known    `take` is not given their masks.
/// return   the cells above the regions, and the regions' roots.
/// errors   those of reading what was spilled, of TreeFrames, and of `take`.
/// Uses the calling thread's TBB arena; the result depends on the model alone.
///
/// source  white, black and grey cells: "Out-of-core real-time haptic interaction
///         on very large models", section 3.1; winding numbers at corners, in
///         place of parity along a line, are ours.
Result<MaskTree> build_mask(const MaskSectors& sectors, const TriangleRuns& runs,
                            const BuiltTree* tree, const KnownRoots& known, const SectorSink& take);

}  // namespace planetree::octree
