#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/nearest/nearest.h"
#include "octree/traversal/bounds.h"

namespace planetree::octree {

/// The best triangle of a traversal so far, and the thresholds for pruning that follow from it.
class BestTriangle {
 public:
  /// span  TreeInfo::span() of the query
  BestTriangle(const FloatQuery& float_query, const NearestLimits& limits, double span)
      : float_query_(float_query),
        limits_(limits),
        max_reach_(limits.max_distance + kValueRounding * (limits.max_distance + span)) {
    refresh();
  }

  bool found() const { return triangle_ != kNoTriangle; }
  /// Whether some surface is known to be within reach().
  bool is_limited() const { return reach_ < max_reach_; }
  std::uint64_t triangle() const { return triangle_; }
  const Triangle& corners() const { return corners_; }
  bool is_height_field() const { return is_height_field_; }
  /// Writes the best triangle's nearest point.
  void write_nearest(NearestOnTriangle& nearest) const { locate(corners_, finding_, nearest); }

  /// Distance beyond which no triangle matters.
  double reach() const { return reach_; }
  /// Children of a greater squared bound are not visited.
  float threshold() {
    if (is_stale_) [[unlikely]]
      lower_threshold();
    return threshold_;
  }
  /// Children of a greater squared bound cannot hold the nearest triangle.
  float exact_threshold() const { return exact_threshold_; }

  /// Lower bound on the true distance of every triangle offered so far. A triangle of greater value
  /// than the best may be truly nearer, if its value is less certain.
  double lower() const { return lower_; }

  /// Returns a distance for limit() where the surface is at most `within` away: the value of a
  /// triangle may exceed its distance.
  static double reach_within(double within, double span) {
    return within + kValueRounding * (within + span) + kCoherenceSlack;
  }

  /// Lowers reach() to `distance`. Some triangle must be within it as computed, and must be offered
  /// later or lie in an unread subtree.
  void tighten(double distance) {
    if (!(distance < reach_)) return;
    reach_ = distance;
    bounded_ = true;
    refresh();
  }

  /// Lowers reach() to `distance`, which some surface is within. An allowed error is left to the
  /// triangles if an answer must have one.
  void limit(double distance) {
    if (!(distance < reach_)) return;
    reach_ = distance;
    bounded_ = !limits_.needs_triangle();
    refresh();
  }

  /// Whether a triangle is the best one again, with a greater index. It then has the same value,
  /// and offering it would change nothing.
  ///
  /// corner  corner(k) returns a corner of the triangle
  template <class Corner>
  bool repeats(const Corner& corner, std::uint64_t index) const {
    return index > triangle_ && corner(0) == corners_[0] && corner(1) == corners_[1] &&
           corner(2) == corners_[2];
  }

  /// Keeps an evaluated triangle if its (value, index) is less than that of the best one.
  ///
  /// is_height_field  flag of the triangle's block
  /// corners          corners(to) writes the triangle's corners
  template <class Corners>
  void offer(const TriangleResult& finding, std::uint64_t index, bool is_height_field,
             Corners corners) {
    const double squared = finding.value.squared;
    const double distance = std::sqrt(squared);
    lower_ = std::min(lower_, distance - finding.value.error);
    const double best = finding_.value.squared;
    if (found() && (squared > best || (squared == best && index >= triangle_))) return;
    if (distance > max_reach_) return;
    finding_ = finding;
    triangle_ = index;
    is_height_field_ = is_height_field;
    corners(corners_);
    if (distance >= reach_) return;
    reach_ = distance;
    bounded_ = true;
    refresh();
  }

 private:
  void refresh() {
    exact_threshold_ = prune_threshold(float_query_, reach_);
    threshold_ = exact_threshold_;
    // max_error needs a distance to some triangle. Queries near the surface do not use it.
    is_stale_ = bounded_ && limits_.max_error > 0;
  }

  void lower_threshold() {
    is_stale_ = false;
    // The rounding of both ends of the interval is part of the error.
    const double max_gain = limits_.max_error - (reach_ + limits_.max_error) * kValueRounding;
    if (max_gain > 0)
      threshold_ =
          std::min(threshold_, prune_threshold(float_query_, std::max(0.0, reach_ - max_gain)));
  }

  const FloatQuery& float_query_;
  const NearestLimits& limits_;
  double max_reach_;  // max_distance and the error of a value near it
  double lower_ = std::numeric_limits<double>::infinity();
  std::uint64_t triangle_ = kNoTriangle;
  bool is_height_field_ = false;
  Triangle corners_{Point::Zero(), Point::Zero(), Point::Zero()};
  TriangleResult finding_;
  double reach_ = max_reach_;
  bool bounded_ = false;   // reach_ is the distance of a triangle or of another point that serves
  bool is_stale_ = false;  // threshold_ is yet to be lowered by max_error
  float threshold_ = 0;
  float exact_threshold_ = 0;
};

/// Least bounds of the subtrees that a traversal skipped; infinity where it skipped none.
struct SkippedBounds {
  /// Least squared bound of the children above the pruning threshold, which max_error lowers.
  float pruned = std::numeric_limits<float>::infinity();
  /// Least squared bound of the children whose page was missing or for which no work was left.
  float unread = std::numeric_limits<float>::infinity();
  /// Some subtree has surface within this distance: one whose page was missing or, of queries of
  /// little work that have found no triangle, one that was to be visited.
  double within = std::numeric_limits<double>::infinity();

  /// Lowers `within` by the box of a subtree, in which there is some surface.
  ///
  /// offset  of the query from the model's centre
  void bound_above(const FloatBox& box, const Point& offset) {
    within = std::min(within, farthest_in_box(box, offset));
  }
};

/// Answers a query within an error by the coarse field alone, which must be there. Returns false if
/// the field is not so certain there.
bool answer_by_field(const Point& query, const NearestLimits& limits,
                     NearestAnswer& answer) noexcept;

/// Makes the answer of a finished traversal.
NearestAnswer finalize(const TreeInfo& tree, const Point& query, const NearestLimits& limits,
                       const BestTriangle& best, const FloatQuery& float_query,
                       const SkippedBounds& skipped) noexcept;

}  // namespace planetree::octree
