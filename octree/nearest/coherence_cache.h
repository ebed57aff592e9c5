#pragma once

#include <algorithm>
#include <limits>

#include "octree/geometry/triangle_distance.h"
#include "octree/traversal/nearby_subtrees.h"
#include "octree/traversal/nearby_triangles.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// The subtrees that reach into a ball, and the triangles that do where they are few, kept from
/// one query for the next ones: those near it start there and not at the root.
///
/// A query's nearest triangle is no farther than the last one's nearest point. Where the ball holds
/// all that is so near, nothing outside it can matter, so that answers are the same bits as from
/// the root. Plain memory: links and copies, no pointers into frames. One thread.
class CoherenceCache {
 public:
  /// How near to the ball's centre a triangle is at most that may be nearest to `query`, or as near
  /// to the last bits.
  double reach_of(const Point& query) const {
    return (nearest_of(query) + (query - centre_).norm()) * (1 + kSlack);
  }
  /// How near to `query` the surface is at least.
  double nearest_of(const Point& query) const {
    return ((query - last_nearest_).norm() + rounding(last_nearest_) + kSlack) * (1 + kSlack);
  }
  /// Whether all of these are in subtrees().
  bool holds(double reach) const { return reach < radius_; }

  const NearbySubtrees& subtrees() const { return subtrees_; }

  /// The radius about `query`, which is `distance` away from the surface, that is worth a new
  /// ball; 0 if `query` is so far from the last one that more such queries would leave it.
  /// `diagonal` is that of the model.
  double wanted_radius(const Point& query, double distance, double diagonal) const {
    const double step = step_to(query);
    return step <= diagonal * kLongestStep ? radius_for(step, distance) : 0;
  }
  /// Those of them that reach into the ball, if these are few.
  const NearbyTriangles& triangles() const { return triangles_; }

  /// Whether all triangles that touch a point, of rounded coordinates, are in subtrees(); then they
  /// are in triangles() too, where these are complete.
  bool has_all_at(const Point& point) const {
    return ((point - centre_).norm() + rounding(point)) * (1 + kSlack) < radius_;
  }

  /// Keeps what reaches into a new ball, if `query` is near enough to the last one for that to
  /// be worth its while. `distance` is the answer to it. Visits at most so many nodes and blocks.
  void renew(const TreeInfo& tree, const Point& query, double distance, std::uint64_t max_work,
             const PageReader& pages, TraversalStats& work) noexcept;

  /// An exact answer.
  void note(const Point& query, const Point& nearest) {
    last_ = query;
    last_nearest_ = nearest;
  }

  /// An exact answer that the ball gave. If the ball is far larger than steps as short as the last
  /// one want, and so holds more than it need, it is forgotten.
  void outlive(const Point& query, double distance, const Point& nearest) {
    if (radius_ > kTooWide * radius_for(step_to(query), distance)) forget();
    note(query, nearest);
  }

  void forget() { radius_ = 0; }

  /// How queries go on: along a path, that leads away from where a ball was made; or along a curve
  /// that fills space, so that it stays near for as many steps.
  enum class Course { kPath, kCurve };
  void follow(Course course) { steps_ = course == Course::kPath ? kPathSteps : kCurveSteps; }

 private:
  double step_to(const Point& query) const { return (query - last_).norm(); }
  // That lasts for a while, about a query `distance` away from the surface.
  double radius_for(double step, double distance) const {
    return distance + steps_ * std::max(step, distance * kMinStep);
  }

  // How far a nearest point may be from the surface, for it is rounded as its coordinates are:
  // a model may be far smaller than they.
  static double rounding(const Point& point) { return point.cwiseAbs().maxCoeff() * 0x1p-51; }

  static constexpr double kSlack = 0x1p-24;       ///< far above what bounds and sums may err
  static constexpr double kLongestStep = 0x1p-6;  ///< as a share of the diagonal
  static constexpr double kMinStep = 0x1p-6;      ///< as a share of the distance
  static constexpr double kPathSteps = 24;        ///< that a ball's radius is wider than wanted
  static constexpr double kCurveSteps = 3;
  static constexpr double kTooWide = 16;  ///< so many times what is wanted

  Point centre_ = Point::Zero();
  Point last_ = Point::Constant(std::numeric_limits<double>::infinity());
  double radius_ = 0;
  double steps_ = kPathSteps;
  Point last_nearest_ = Point::Zero();
  NearbySubtrees subtrees_;
  NearbyTriangles triangles_;
};

}  // namespace planetree::octree
