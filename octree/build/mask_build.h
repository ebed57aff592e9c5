#pragma once

#include <cstddef>
#include <functional>

#include "octree/build/mask_regions.h"
#include "octree/build/mask_tree.h"
#include "octree/build/triangle_runs.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Takes the mask of a region, its root the first entry; on any thread.
using RegionSink = std::function<Result<void>(std::size_t region, MaskTree mask)>;

/// Makes the mask of a model, region by region: winding numbers are known outside the model's
/// box, and carried from there to the least corner of every region by the crossings of regions'
/// edges.
///
/// regions  of a watertight model, all of whose triangles were added.
/// return   the cells above the regions, and the regions' roots.
/// errors   those of reading what was spilled, and of `take`.
/// Uses the calling thread's TBB arena; the result depends on the model alone.
///
/// source  white, black and grey cells: "Out-of-core real-time haptic interaction
///         on very large models", section 3.1; winding numbers at corners, in
///         place of parity along a line, are ours.
Result<MaskTree> build_mask(const MaskRegions& regions, const TriangleRuns& runs,
                            const RegionSink& take);

}  // namespace planetree::octree
