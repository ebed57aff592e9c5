#pragma once

#include <functional>

#include "octree/build/mask_regions.h"
#include "octree/build/mask_tree.h"
#include "octree/build/triangle_runs.h"
#include "planetree/error.h"

namespace planetree::octree {

/// The mask of a model, region by region: winding numbers are known outside the model's box, and
/// carried from there to the least corner of every region by the crossings of regions' edges.
///
/// regions  of a watertight model, all of whose triangles were added.
/// done     told, on any thread, after each region.
/// memory   20 bytes an entry, one for 4 to 8 triangles, and a region's triangles a thread.
/// errors   those of reading what was spilled.
/// Uses the calling thread's TBB arena; the result depends on the model alone.
///
/// source  white, black and grey cells: "Out-of-core real-time haptic interaction
///         on very large models", section 3.1; winding numbers at corners, in
///         place of parity along a line, are ours.
Result<MaskTree> build_mask(const MaskRegions& regions, const TriangleRuns& runs,
                            const std::function<void()>& done);

}  // namespace planetree::octree
