#pragma once

#include <cstdint>

#include "planetree/types.h"

namespace planetree::query {

/// Where a point stands with respect to a model's surface.
struct SideResult {
  Side side = Side::kUnknown;
  Status status = Status::kExact;  ///< kDegraded: pages missing or the work spent
  /// Of watertight models as much as 0, and of the sign of, the winding number of
  /// the point; else that to the nearest whole number where the side is known. On
  /// the surface: of a step beside the point if `beside`, else 1 or -1 as the rest
  /// of the surface winds about it, 0 where that is too little to tell.
  std::int64_t winding = 0;
  bool beside = true;
};

}  // namespace planetree::query
