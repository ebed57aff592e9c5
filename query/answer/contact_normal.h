#pragma once

#include "octree/nearest/feature_normal.h"
#include "octree/nearest/nearest.h"
#include "query/answer/side.h"

namespace planetree::query {

/// Returns the unit normal at a nearest point. It points out of the solid; if the side is unknown,
/// it follows the orientation of the mesh. It is (0, 0, 1) if no face at the feature has area.
///
/// query, nearest  a query and its answer, which names a triangle; model frame
/// feature         pseudo-normal at the nearest point
/// side_result     side of the query
octree::Point contact_normal(const octree::Point& query, const octree::NearestAnswer& nearest,
                             const octree::FeatureNormal& feature,
                             const SideResult& side_result) noexcept;

}  // namespace planetree::query
