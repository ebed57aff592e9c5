#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/tree_limits.h"
#include "octree/geometry/triangle_distance.h"
#include "octree/page/frame.h"
#include "octree/traversal/tree_view.h"

/// Lower bounds, in float, on the distance to the surface within a child's box and disc, and on the
/// distance to triangles; and their errors.
///
/// With p the query, d its distance to that surface, c the centre of the box, n the slab's normal
/// and v = kFloatRoundoff:
///
///     box    d >= distance from p to the box
///     disc   h = n.(p-c); s = max(0, slab_lower - h, h - slab_upper);
///            t = max(0, sqrt(|p-c|^2 - h^2) - radius);  d >= sqrt(s^2 + t^2)
///
/// Errors. Rounding p to float moves the query by at most sqrt(3) v |p|. Box bounds then err by a
/// factor (1 + 4 v). For the disc let D = |p-c| <= d + r, where r is the box diagonal, since c may
/// be rounded to a corner. h errs by 8 v D. The part 8 v d is a factor on d; the part 8 v r is more
/// than covered by what the builder adds to the stored offsets (kDiscOffsetSlack). |p-c|^2 - h^2
/// cancels, so that kDiscCancellation * D^2 is subtracted first: more than its rounding error (24 v
/// D^2) and that of the normal (8 v D^2) together. Every computed bound b therefore obeys
///
///     b <= d (1 + 16 v) + sqrt(3) v |p|.
///
/// Thresholds are inflated by more than that, so that comparing a bound with a threshold never
/// drops a child that matters.
///
/// The triangle filter bounds squared distances by the edges of a triangle and, unless its sine is
/// small, by its face. Its kernel takes kFilterEdgeError and kFilterFaceError off, lane by lane.
/// The corners and the query are rounded relative to the block, by less than kFilterPositionSlack
/// times (distance + block extent).
///
/// source  bounding planes of the EBP-octree, section 3. The disc is our own: a slab has no end, a
///         disc has.
namespace planetree::octree {

/// A query rounded to float for the vector kernels, relative to the model's centre.
struct FloatQuery {
  float x = 0, y = 0, z = 0;
  double slack = 0;     ///< bound on the query's rounding error, plus that of bounds
  bool usable = false;  ///< false: too far for squares in float, nothing may be pruned

  /// Converts a query in the model frame.
  static FloatQuery from(const Point& query, const TreeInfo& tree) {
    const Point& centre = tree.centre;
    return from(query.x() - centre.x(), query.y() - centre.y(), query.z() - centre.z(),
                tree.bound_slack);
  }
  static FloatQuery from(double x, double y, double z, double bound_slack = kAbsoluteBoundSlack) {
    const double largest = std::max({std::fabs(x), std::fabs(y), std::fabs(z)});
    FloatQuery query;
    query.slack = kFloatQueryRounding * largest + bound_slack;
    query.usable = largest < kMaxFloatQuery;
    if (!query.usable) return query;
    query.x = static_cast<float>(x);
    query.y = static_cast<float>(y);
    query.z = static_cast<float>(z);
    return query;
  }
};

/// Returns an upper bound on the distance from a query to the surface points in a box. Both are
/// relative to the model's centre.
inline double farthest_in_box(const FloatBox& box, const Point& query) {
  double squared = 0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double at = query[axis];
    const double farther = std::max(std::fabs(at - static_cast<double>(box.lower[axis])),
                                    std::fabs(at - static_cast<double>(box.upper[axis])));
    squared += farther * farther;
  }
  return std::sqrt(squared) * kFarthestInflation + kAbsoluteBoundSlack;
}

/// Rounds up to float. Returns at least the least normal float, so that squares that underflow are
/// kept.
inline float round_up(double value) {
  if (!(value < kMaxFloatSquare)) return std::numeric_limits<float>::infinity();
  const float rounded =
      static_cast<float>(std::max(value * kRoundUpInflation, double{kMinFloatNormal}));
  return rounded;
}

/// Returns a threshold: a child whose squared bound exceeds it is farther than `distance`.
inline float prune_threshold(const FloatQuery& query, double distance) {
  if (!query.usable) return std::numeric_limits<float>::infinity();
  const double reach = (distance + query.slack) * kBoundInflation;
  return round_up(reach * reach);
}

/// Returns the lower bound on the distance that a computed squared bound proves.
inline double certified(const FloatQuery& query, float bound_squared) {
  if (!query.usable) return 0;
  return std::max(0.0,
                  std::sqrt(static_cast<double>(bound_squared)) / kBoundInflation - query.slack);
}

/// Returns whether float suffices to filter a block's triangles for a query.
inline bool can_filter(const FloatQuery& query, float block_extent) {
  return query.usable && block_extent >= kFilterMinExtent && block_extent <= kFilterMaxExtent;
}

/// Returns whether the box of a triangle proves that its value exceeds `distance`: for blocks that
/// cannot be filtered in float. A difference in double errs by 2^-53 of itself.
inline bool is_beyond(const Triangle& triangle, const Point& point, const FloatQuery& query,
                      double distance) {
  const Point below = least_corner(triangle) - point, above = point - greatest_corner(triangle);
  const double gap = below.cwiseMax(above).maxCoeff();
  return gap > (distance + query.slack) * kBoundInflation;
}

/// Returns an upper bound on the distance to a triangle with this filter value.
inline double filter_upper(float squared, float block_extent) {
  const double value = std::sqrt(static_cast<double>(squared));
  return value + 2 * kFilterPositionSlack * (value + static_cast<double>(block_extent));
}

/// Returns a lower bound on the distance to a triangle with this filter value, which is itself a
/// lower bound.
inline double filter_lower(float squared, float block_extent) {
  const double value = std::sqrt(static_cast<double>(squared));
  return std::max(0.0,
                  value - 2 * kFilterPositionSlack * (value + static_cast<double>(block_extent)));
}

/// Returns a threshold: a triangle whose filter value exceeds it is farther than `distance`.
inline float filter_threshold(const FloatQuery& query, double distance, float block_extent) {
  if (!can_filter(query, block_extent)) return std::numeric_limits<float>::infinity();
  const double reach =
      distance + kFilterPositionSlack * (distance + static_cast<double>(block_extent));
  return round_up(reach * reach);
}

}  // namespace planetree::octree
