#pragma once

#include <cstdint>

#include "octree/tree_view.h"
#include "planetree/types.h"
#include "query/model_state.h"

namespace planetree::query {

/// Which side of a model's surface a point is on.
///
/// point      model frame.
/// max_nodes  most nodes and blocks to visit.
/// return     kExact with the side of a watertight model, kUnknown of another;
///            kDegraded with kUnknown where pages are missing or the work is
///            spent.
Containment find_side(const ModelState& model, const octree::Point& point, std::uint64_t max_nodes,
                      octree::PageReader pages, octree::TreeWork& work) noexcept;

}  // namespace planetree::query
