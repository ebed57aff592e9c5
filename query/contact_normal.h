#pragma once

#include <cstdint>

#include "octree/nearest.h"
#include "query/side.h"

namespace planetree::query {

struct ContactNormal {
  octree::Point normal{0, 0, 1};
  bool complete = true;  ///< false: pages missing or the work spent
};

/// The normal at a nearest point, out of the solid; as the mesh is oriented
/// where the side is unknown.
///
/// query, nearest  model frame; `nearest` names a triangle.
/// vicinity        of `nearest`; may be null.
ContactNormal contact_normal(const octree::TreeFacts& tree, const octree::Point& query,
                             const octree::NearestAnswer& nearest, const Standing& standing,
                             const octree::Vicinity* vicinity, std::uint64_t max_nodes,
                             octree::PageReader pages, octree::TreeWork& work) noexcept;

}  // namespace planetree::query
