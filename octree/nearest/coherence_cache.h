#pragma once

#include <algorithm>
#include <limits>

#include "octree/field/coarse_field.h"
#include "octree/geometry/error_bounds.h"
#include "octree/geometry/triangle_distance.h"
#include "octree/traversal/nearby_lists.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

class WorkLimit;

/// The subtrees that reach into a ball about an earlier query, and the triangles that do if they
/// are few. Queries near that one start there instead of at the root.
///
/// The nearest triangle of a query is no farther than the last query's nearest point. If the ball
/// holds everything within that distance, nothing outside of it can matter, so that the answer has
/// the same bits as one from the root. The cache holds links and copies, no pointers into frames.
/// Lengths are in the model frame. For one thread.
class CoherenceCache {
 public:
  /// Upper bound on the distance from the ball's centre of every triangle that may be nearest to
  /// `query`, or as near up to the last bits.
  double reach_of(const Point& query) const {
    return (nearest_of(query) + (query - centre_).norm()) * (1 + kCoherenceSlack);
  }
  /// Upper bound on the distance from `query` to the surface.
  double nearest_of(const Point& query) const {
    return ((query - last_nearest_).norm() + rounding(last_nearest_) + kCoherenceSlack) *
           (1 + kCoherenceSlack);
  }
  /// Whether subtrees() has all triangles within `reach` of the centre.
  bool holds(double reach) const { return reach < radius_; }

  const NearbySubtrees& subtrees() const { return subtrees_; }

  /// Radius of a new ball about `query`. It is 0 if `query` is so far from the last query that more
  /// steps like this one would leave the ball.
  ///
  /// distance  from `query` to the surface
  /// diagonal  of the model's core
  double wanted_radius(const Point& query, double distance, double diagonal) const {
    return is_near_last(query, diagonal) ? radius_for(step_to(query), distance) : 0;
  }
  /// Whether a query is so near the last one that a ball about it may serve the next ones.
  bool is_near_last(const Point& query, double diagonal) const {
    return step_to(query) <= diagonal * kMaxStepShare;
  }
  /// The triangles of subtrees() that reach into the ball; complete only if they are few.
  const NearbyTriangles& triangles() const { return triangles_; }

  /// Whether subtrees() has all triangles that touch `point`, whose coordinates are rounded.
  /// triangles() then has them too, if it is complete.
  bool has_all_at(const Point& point) const {
    return ((point - centre_).norm() + rounding(point)) * (1 + kCoherenceSlack) < radius_;
  }

  /// Makes a new ball about `query`, if wanted_radius() is above 0.
  ///
  /// distance  from `query` to the surface, as its exact answer says
  /// limit     of the work; if it does not suffice or a page is missing, the ball has larger
  ///           subtrees and no triangles, or is dropped
  void renew(const TreeInfo& tree, const Point& query, double distance, WorkLimit& limit,
             const PageReader& pages, TraversalStats& work) noexcept;

  /// Records a query and a surface point near it.
  void note(const Point& query, const Point& nearest) {
    last_ = query;
    last_nearest_ = nearest;
  }

  /// Records what the coarse field tells near the last query.
  void note_field(const CoarseField::Estimate& estimate) { field_ = estimate; }
  const CoarseField::Estimate& field() const { return field_; }

  /// Records an exact answer that came from the ball. Drops the ball if it is far larger than steps
  /// of the last length need, because it then holds too much.
  void note_and_trim(const Point& query, double distance, const Point& nearest) {
    if (radius_ > kMaxRadiusRatio * radius_for(step_to(query), distance)) forget();
    note(query, nearest);
  }

  /// Drops the ball.
  void forget() { radius_ = 0; }

  /// How queries follow each other: in the caller's order, as along a path, or in that of a batch,
  /// which is not the caller's, along a space-filling curve.
  enum class Course { kPath, kCurve };
  void follow(Course course) { course_ = course; }
  Course course() const { return course_; }

 private:
  double step_to(const Point& query) const { return (query - last_).norm(); }
  // Radius of a ball that lasts for kSteps, about a query `distance` from the surface.
  double radius_for(double step, double distance) const {
    return distance + kSteps * std::max(step, distance * kMinStepShare);
  }

  // Upper bound on the distance of a nearest point from the surface. Its coordinates are rounded,
  // and they may be far larger than the model.
  static double rounding(const Point& point) {
    return point.cwiseAbs().maxCoeff() * kNearestPointRounding;
  }

  static constexpr double kMaxStepShare = 0x1p-6;  ///< share of the model's diagonal
  static constexpr double kMinStepShare = 0x1p-6;  ///< share of the distance to the surface
  static constexpr double kSteps = 24;             ///< steps that a ball lasts for
  static constexpr double kMaxRadiusRatio = 16;    ///< dropped beyond this multiple of radius_for()

  Point centre_ = Point::Zero();
  Point last_ = Point::Constant(std::numeric_limits<double>::infinity());
  double radius_ = 0;
  Course course_ = Course::kPath;
  Point last_nearest_ = Point::Zero();
  CoarseField::Estimate field_;
  NearbySubtrees subtrees_;
  NearbyTriangles triangles_;
};

}  // namespace planetree::octree
