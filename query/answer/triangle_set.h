#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "planetree/types.h"
#include "query/answer/query_context.h"

namespace planetree::query {

/// Which triangles about a point are wanted.
struct TriangleSetQuery {
  Vec3 centre;             ///< model units
  double radius = 0;       ///< model units, >= 0; may be infinite
  bool wants_all = false;  ///< all within the radius, and not only as many as fit
};

/// The triangles found.
struct TriangleSet {
  Found found;
  bool is_degraded = false;  ///< some may lack, because pages or work did
};

/// Writes the triangles nearest to a point to `found`, as Probe::nearest_triangles() and
/// Probe::triangles_within() state, but for the sides.
///
/// options  returned by with_defaults(); is_valid() holds
TriangleSet find_triangles(const QueryContext& context, const TriangleSetQuery& query,
                           const QueryOptions& options, std::span<ClosestPoint> found) noexcept;

/// Reads the pages that find_triangles() needs for as many triangles.
void visit_triangles(const QueryContext& context, const TriangleSetQuery& query,
                     std::uint64_t count, const QueryOptions& options) noexcept;

}  // namespace planetree::query
