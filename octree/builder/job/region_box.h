#pragma once

#include "octree/builder/job/model_frame.h"
#include "octree/geometry/cell_grid.h"
#include "planetree/error.h"
#include "planetree/types.h"

namespace planetree::octree {

/// A box in the input's units. Coordinates are finite; those of `upper` are not below those of
/// `lower`.
struct RegionBox {
  Vec3 lower, upper;

  /// errors  kBadArgument: a coordinate is not finite, or `upper` is below `lower`.
  Result<void> check() const;
  /// errors  kBadArgument: the box has no point in common with the box of the mesh.
  Result<void> check_meets(const ModelFrame& frame) const;
  /// The region in the model frame. The box must have a point in common with that of the mesh.
  Region region(const ModelFrame& frame) const;
};

/// The error that no triangle of a mesh touches a box.
Error no_triangle_touches(const ModelFrame& frame);

}  // namespace planetree::octree
