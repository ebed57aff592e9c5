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

/// A box of which the triangles that touch it are wanted.
class BoxSetQuery {
 public:
  explicit BoxSetQuery(const Box& box) : box_(box) {}

  const Box& box() const { return box_; }
  /// Whether it is finite and not inside out.
  bool is_valid() const;
  Vec3 centre() const;  ///< model units
  /// No point of the box is farther from the centre; model units.
  double radius() const;

 private:
  Box box_;
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

/// The same for the triangles that touch a box. If it is degraded, so are all answers.
TriangleSet find_triangles(const QueryContext& context, const BoxSetQuery& query,
                           const QueryOptions& options, std::span<ClosestPoint> found) noexcept;

/// Reads the pages that find_triangles() needs for as many triangles.
void visit_triangles(const QueryContext& context, const TriangleSetQuery& query,
                     std::uint64_t count, const QueryOptions& options) noexcept;

}  // namespace planetree::query
