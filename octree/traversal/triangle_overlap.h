#pragma once

#include <array>
#include <cstdint>

#include "octree/geometry/triangle_distance.h"
#include "octree/page/block_view.h"
#include "octree/page/frame.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/nearby_triangles.h"

/// Which triangles of a block, or of a list, are where: a bit for each.
namespace planetree::octree {

/// Those that may be as near to a point as `distance`; the others are farther. Fills in how near
/// each of the former is at least.
///
/// wide  the point as float has it, see FloatQuery::from().
unsigned triangles_within(const BlockView& block, const Point& point, const FloatQuery& wide,
                          double distance, double (&nearest)[kMaxBlockTriangles]) noexcept;

/// Those that may have this corner, by one coordinate in float; the others do not. Sixty-four a
/// word.
using ListedBits = std::array<std::uint64_t, NearbyTriangles::kMax / 64>;
ListedBits triangles_with_corner(const NearbyTriangles& list, const Point& corner) noexcept;

}  // namespace planetree::octree
