#pragma once

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

class WorkLimit;

/// Returns whether a closed triangle touches the closed box from `lower` to `upper`, without any
/// error. The triangle may be a segment or a point, the box may be flat.
///
/// Points are in the model frame. Coordinates are finite, of magnitude at most 2^301.
/// limit   charged for signs that take integers. If it refuses, which limit.exceeded() tells, the
///         result has no meaning. The caller charges WorkUnits::kBoxOverlap.
/// source  separating axes: Akenine-Moeller 2001, "Fast 3D triangle-box overlap testing". The axes
///         across an edge of each are those of two shapes in the plane: a projected triangle and a
///         rectangle. Exact predicates tell on which side of an edge corners are.
bool touches_box(const Triangle& triangle, const Point& lower, const Point& upper,
                 WorkLimit& limit);

}  // namespace planetree::octree
