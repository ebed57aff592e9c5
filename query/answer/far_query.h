#pragma once

#include "octree/nearest/nearest.h"
#include "octree/traversal/tree_view.h"
#include "planetree/types.h"

/// Queries beyond octree::kMaxQueryCoordinate, from which all triangles are equally far in double.
namespace planetree::query {

/// Returns the nearest point of a far query.
///
/// from  a point at octree::kMaxQueryCoordinate in the direction of the query
octree::NearestAnswer farthest(const octree::TreeInfo& tree, const octree::Point& from);

/// Sets the distance of a far query. Computes in model units, since the model frame could overflow.
void measure_far(const Vec3& query, const QueryOptions& options, ClosestPoint& answer);

}  // namespace planetree::query
