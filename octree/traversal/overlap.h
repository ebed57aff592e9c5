#pragma once

#include <array>
#include <cstdint>

#include "octree/geometry/child_bounds.h"
#include "octree/geometry/triangle_distance.h"
#include "octree/page/frame.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/nearby_lists.h"

/// Tests of a node's children, of a list of subtrees, and of the triangles of a block or of a list,
/// against a box or a point. Results have a bit for each child, subtree or triangle.
namespace planetree::octree {

/// Returns a bit for each child, or subtree, whose box meets `box`.
unsigned children_meeting(const Node& node, const FloatBox& box) noexcept;
std::uint64_t subtrees_meeting(const NearbySubtrees& list, const FloatBox& box) noexcept;

/// Adds to `list` the children of `node` whose boxes are not farther from the query than
/// `threshold` (see prune_threshold()). `list` must have capacity, see
/// NearbySubtrees::has_capacity().
void add_children_within(const Node& node, const FloatQuery& query, float threshold,
                         NearbySubtrees& list) noexcept;

/// Returns the triangles that may be within `distance` of a point; the others are farther. For each
/// triangle returned, `nearest` receives a lower bound on its distance.
///
/// wide  the point rounded to float, see FloatQuery::from()
unsigned triangles_within(const BlockView& block, const Point& point, const FloatQuery& wide,
                          double distance, double (&nearest)[kMaxBlockTriangles]) noexcept;

/// Returns the triangles that may have this corner, as found by one coordinate in float; the others
/// do not have it. A word holds the bits of 64 triangles.
using NearbyTriangleBits = std::array<std::uint64_t, NearbyTriangles::kMax / 64>;
NearbyTriangleBits triangles_with_corner(const NearbyTriangles& list, const Point& corner) noexcept;

}  // namespace planetree::octree
