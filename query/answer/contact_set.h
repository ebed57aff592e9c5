#pragma once

#include <span>

#include "octree/nearest/contact_triangles.h"
#include "planetree/types.h"
#include "query/answer/query_context.h"

namespace planetree::query {

/// The contacts found.
struct ContactSet {
  Found found;
  /// Some may lack, or not be contacts, because pages or work were missing.
  bool is_degraded = false;
  bool nearest_is_incomplete = false;  ///< as closest_point() returns for the nearest one
  double reach = 0;  ///< model units: distance within which triangles were searched
};

/// Writes the contacts of a point to `found`, as Probe::contacts() states.
///
/// radius     model units, >= 0; may be infinite
/// options    returned by with_defaults(); is_valid() holds
/// triangles  memory for the search
ContactSet find_contacts(const QueryContext& context, const Vec3& centre, double radius,
                         const QueryOptions& options, octree::ContactTriangles& triangles,
                         std::span<ClosestPoint> found) noexcept;

}  // namespace planetree::query
