#pragma once

#include "octree/block_view.h"
#include "octree/bounds.h"
#include "octree/frame.h"
#include "octree/triangle_distance.h"

/// Which of a block's triangles are where: a bit for each.
namespace planetree::octree {

/// Those that may be as near to a point as `distance`; the others are farther. Fills in how near
/// each of the former is at least.
///
/// wide  the point as float has it, see FloatQuery::from().
unsigned triangles_within(const BlockView& block, const Point& point, const FloatQuery& wide,
                          double distance, double (&nearest)[kMaxBlockTriangles]) noexcept;

}  // namespace planetree::octree
