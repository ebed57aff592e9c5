#pragma once

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// Whether a closed triangle may touch the closed box from `lower` to `upper`:
/// false only if it certainly does not.
///
/// Both in the model frame, with differences below 2^500.
/// source  separating axes, Akenine-Moeller 2001, "Fast 3D triangle-box overlap
///         testing"; the margins for rounding are ours.
bool may_touch(const Triangle& triangle, const Point& lower, const Point& upper);

}  // namespace planetree::octree
