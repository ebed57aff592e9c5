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
  /// As much as 0 and of the sign of the winding number of the point, of a step
  /// beside it on the surface.
  std::int64_t winding = 0;
};

/// Which side of a model's surface a point is on.
///
/// point      model frame.
/// max_nodes  most nodes and blocks to visit.
/// return     kUnknown of a model that is not watertight, and where degraded.
Standing find_side(const ModelState& model, const octree::Point& point, std::uint64_t max_nodes,
                   octree::PageReader pages, octree::TreeWork& work) noexcept;

}  // namespace planetree::query
