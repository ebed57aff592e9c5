#pragma once

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// Returns whether a closed triangle may touch the closed box from `lower` to `upper`; false only
/// if it certainly does not.
///
/// All points are in the model frame; their differences are below 2^500.
/// source  separating axes: Akenine-Moeller 2001, "Fast 3D triangle-box overlap testing"; the
///         margins for rounding are our own
bool may_touch(const Triangle& triangle, const Point& lower, const Point& upper);

}  // namespace planetree::octree
