#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "octree/nearest/nearest.h"
#include "octree/traversal/bounds.h"

namespace planetree::octree {

/// The best triangle of a descent so far and what may be pruned because of it.
class BestTriangle {
 public:
  BestTriangle(const FloatQuery& wide, const NearestLimits& limits) : wide_(wide), limits_(limits) {
    refresh();
  }

  bool found() const { return triangle_ != kNoTriangle; }
  std::uint64_t triangle() const { return triangle_; }
  const Triangle& corners() const { return corners_; }
  bool is_height_field() const { return is_height_field_; }
  /// Writes its nearest point.
  void place_nearest(NearestOnTriangle& nearest) const { locate(corners_, finding_, nearest); }

  /// Nothing farther than this is of interest.
  double reach() const { return reach_; }
  /// Child bounds above this are not worth a visit.
  float threshold() const { return threshold_; }
  /// Child bounds above this cannot hold the nearest triangle.
  float exact_threshold() const { return exact_threshold_; }

  /// No triangle offered so far is truly nearer than this: one of a greater
  /// value may be, if its value is less certain.
  double lower() const { return lower_; }

  /// Some triangle has a value of at most `distance`: it will be offered, or is left unread.
  void tighten(double distance) {
    if (!(distance < reach_)) return;
    reach_ = distance;
    bounded_ = true;
    refresh();
  }

  /// Keeps a triangle that was evaluated if (value, index) is less; `is_height_field` is its
  /// block's, `corners(to)` writes its corners.
  template <class Corners>
  void offer(const TriangleFinding& finding, std::uint64_t index, bool is_height_field,
             Corners corners) {
    const double squared = finding.value.squared;
    const double distance = std::sqrt(squared);
    lower_ = std::min(lower_, distance - finding.value.error);
    const double best = finding_.value.squared;
    if (found() && (squared > best || (squared == best && index >= triangle_))) return;
    if (distance > farthest_) return;
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
    exact_threshold_ = prune_threshold(wide_, reach_);
    threshold_ = exact_threshold_;
    // While nothing is found there is nothing that an error could be allowed of.
    if (!bounded_ || !(limits_.max_error > 0)) return;
    // The last 2^-40 pays for the rounding of both ends of the interval.
    const double wanted = limits_.max_error - (reach_ + limits_.max_error) * 0x1p-40;
    if (wanted > 0)
      threshold_ = std::min(threshold_, prune_threshold(wide_, std::max(0.0, reach_ - wanted)));
  }

  const FloatQuery& wide_;
  const NearestLimits& limits_;
  // max_distance and what a value near it may err: no corner is farther away
  // than that and a diagonal of the model, which is below 4 (see
  // octree/geometry/triangle_distance.cpp for the factor).
  double farthest_ = limits_.max_distance + 0x1p-40 * (limits_.max_distance + 4);
  double lower_ = std::numeric_limits<double>::infinity();
  std::uint64_t triangle_ = kNoTriangle;
  bool is_height_field_ = false;
  Triangle corners_{Point::Zero(), Point::Zero(), Point::Zero()};
  TriangleFinding finding_;
  double reach_ = farthest_;
  bool bounded_ = false;  // reach_ is that of a triangle
  float threshold_ = 0;
  float exact_threshold_ = 0;
};

}  // namespace planetree::octree
