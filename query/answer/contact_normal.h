#pragma once

#include "octree/nearest/feature_normal.h"
#include "octree/nearest/nearest.h"
#include "query/answer/side.h"

namespace planetree::query {

/// The normal at a nearest point, out of the solid; as the mesh is oriented
/// where the side is unknown.
///
/// query, nearest  model frame; `nearest` names a triangle.
/// feature         that of both.
octree::Point contact_normal(const octree::Point& query, const octree::NearestAnswer& nearest,
                             const octree::FeatureNormal& feature,
                             const SideResult& side_result) noexcept;

}  // namespace planetree::query
