#pragma once

#include "octree/builder/job/model_frame.h"
#include "octree/geometry/region.h"
#include "planetree/error.h"
#include "planetree/types.h"

namespace planetree::octree {

/// A box of the input's space: finite, `upper` nowhere below `lower`.
struct RegionBox {
  Vec3 lower, upper;

  /// errors  kBadArgument: this is no box.
  Result<void> check() const;
  /// errors  kBadArgument: it is nowhere near a mesh of that frame.
  Result<void> check_near(const ModelFrame& frame) const;
  /// In the model frame of a mesh that it is near to.
  Region region(const ModelFrame& frame) const;
};

/// That no triangle of a mesh touches a box.
Error nothing_touches(const ModelFrame& frame);

}  // namespace planetree::octree
