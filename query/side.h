#pragma once

#include <cstdint>

#include "octree/tree_view.h"
#include "planetree/types.h"
#include "query/model_state.h"

namespace planetree::query {

/// Where a point stands with respect to a model's surface.
struct Standing {
  Side side = Side::kUnknown;
  Status status = Status::kExact;  ///< kDegraded: pages missing or the work spent
  /// Winding number of the point, to the nearest whole number where the side is
  /// known. On the surface: of a step beside the point if `beside`, else 1 or -1
  /// as the rest of the surface winds about it, 0 where that is too little to tell.
  std::int64_t winding = 0;
  bool beside = true;
};

/// Which side of a model's surface a point is on.
///
/// point      model frame.
/// max_nodes  most nodes and blocks to visit.
/// return     kUnknown where degraded, and where the winding number of a model
///            that is not watertight is one half to rounding.
Standing find_side(const ModelState& model, const octree::Point& point, std::uint64_t max_nodes,
                   octree::PageReader pages, octree::TreeWork& work) noexcept;

}  // namespace planetree::query
