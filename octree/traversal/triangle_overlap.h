#pragma once

#include <array>
#include <cstdint>

#include "octree/geometry/triangle_distance.h"
#include "octree/page/block_view.h"
#include "octree/page/frame.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/nearby_triangles.h"

/// Tests of the triangles of a block, or of a list. Results have a bit for each triangle.
namespace planetree::octree {

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
