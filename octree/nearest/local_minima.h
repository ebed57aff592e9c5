#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "octree/geometry/triangle_distance.h"
#include "octree/nearest/contact_triangles.h"

namespace planetree::octree {

class WorkLimit;

/// Tells which triangles near a query have a local minimum of the distance from it to the surface.
///
/// A triangle is convex, so that its nearest point is its only local minimum. Triangles that share
/// corners are joined there. A triangle T is no local minimum of its own if a path over the surface
/// leads from its nearest point to a triangle that comes before T by (value, index), and no
/// point of the path is farther from the query than T by more than a tolerance. So the distance
/// can fall from T without rising first. Paths go from triangle to triangle through the nearest
/// point of the edge or vertex that they share. The path may also begin with a step over a gap that
/// is no wider than the tolerance, as at the corner of a triangle within another one's edge.
///
/// The tolerance is the error of the computed distances, so that neither a plane that is cut into
/// triangles nor rounding adds minima; and what the caller adds to it.
class LocalMinima {
 public:
  /// triangles  joined; must outlive this
  /// tolerance  what the caller adds, >= 0
  /// limit      charged for the search; must outlive this
  LocalMinima(const ContactTriangles& triangles, const Point& query, double tolerance,
              WorkLimit& limit);

  /// Distance that a path from the triangle of a rank must exceed to lead to another minimum. All
  /// triangles within it must be known.
  double level(std::size_t rank) const;

  enum class Kind : std::uint8_t { kMinimum, kNone, kUnknown };
  /// Returns kUnknown if the limit refuses.
  ///
  /// nearest  receives the triangle's nearest point if it is a minimum
  Kind kind(std::size_t rank, NearestOnTriangle& nearest);

 private:
  bool has_earlier_at_feature(std::size_t rank);
  Kind search(std::size_t rank);
  bool visit_vertex(std::size_t entry, unsigned k, unsigned near_edges, bool is_near);
  bool touches_earlier(std::size_t rank, const Point& point);
  double tolerance_of(const ContactTriangles::Entry& entry) const;
  bool is_within(const Point& a, const Point& b, double distance) const;
  bool take_distance(const Triangle& triangle);
  bool take_steps(unsigned steps);

  const ContactTriangles& triangles_;
  const Point query_;
  const double tolerance_;
  WorkLimit& limit_;
  unsigned steps_ = 0;  // not charged yet
  // Of one search: the triangles reached, in order, and a mark for each that was.
  std::size_t begin_ = 0;  // rank
  std::size_t reached_ = 0;
  std::array<std::uint16_t, ContactTriangles::kMax> queue_;
  std::array<bool, ContactTriangles::kMax> is_reached_{};
};

}  // namespace planetree::octree
