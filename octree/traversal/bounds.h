#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "octree/geometry/triangle_distance.h"
#include "octree/page/frame.h"

/// Lower bounds, in float, on the distance to the surface within a child's box and disc, and their
/// errors.
///
/// With p the query, d its distance to that surface, c the centre of the box, n the slab's normal
/// and u = 2^-24:
///
///     box    d >= distance from p to the box
///     disc   h = n.(p-c); s = max(0, slab_lower - h, h - slab_upper);
///            t = max(0, sqrt(|p-c|^2 - h^2) - radius);  d >= sqrt(s^2 + t^2)
///
/// Errors. Rounding p to float moves the query by at most sqrt(3) u |p|. Box bounds then err by a
/// factor (1 + 4u). For the disc let D = |p-c| <= d + r, where r is the box diagonal, since c may
/// be rounded to a corner. h errs by 8uD. The part 8ud is a factor on d; the part 8ur is more than
/// covered by what the builder adds to the stored offsets (kPlaneSlack). |p-c|^2 - h^2 cancels, so
/// that kCancellation * D^2 is subtracted first: more than its rounding error (24u D^2) and that of
/// the normal (8u D^2) together. Every computed bound b therefore obeys
///
///     b <= d (1 + 16u) + sqrt(3) u |p|.
///
/// Thresholds are inflated by more than that, so that comparing a bound with a threshold never
/// drops a child that matters.
///
/// source  bounding planes of the EBP-octree, section 3. The disc is our own: a slab has no end, a
///         disc has.
namespace planetree::octree {

inline constexpr float kUlp = 0x1p-24f;
inline constexpr float kCancellation = 40 * kUlp;
inline constexpr double kPlaneSlack = 16 * 0x1p-24;  ///< times the box diagonal
inline constexpr double kBoundFactor = 1 + 32 * 0x1p-24;

/// Absolute part of the slack. Doubles relative to the centre are rounded to 2^-53 of the model's
/// side, plane offsets of boxes smaller than 2^-63 underflow, and a triangle's value may err by
/// 2^-40 (octree/geometry/triangle_distance.h). With this slack no triangle is pruned that is
/// equally near within the error of its value, in whatever order children are visited.
inline constexpr double kAbsoluteSlack = 0x1p-38;

/// A query rounded to float for the vector kernels, relative to the model's centre.
struct FloatQuery {
  float x = 0, y = 0, z = 0;
  double slack = 0;     ///< bound on the query's rounding error, plus kAbsoluteSlack
  bool usable = false;  ///< false: too far for squares in float, nothing may be pruned

  /// Converts a query in the model frame. `centre` is the model's centre.
  static FloatQuery from(const Point& query, const Point& centre) {
    return from(query.x() - centre.x(), query.y() - centre.y(), query.z() - centre.z());
  }
  static FloatQuery from(double x, double y, double z) {
    const double largest = std::max({std::fabs(x), std::fabs(y), std::fabs(z)});
    FloatQuery query;
    query.usable = largest < 0x1p60;
    if (!query.usable) return query;
    query.x = static_cast<float>(x);
    query.y = static_cast<float>(y);
    query.z = static_cast<float>(z);
    query.slack = 2 * 0x1p-24 * largest + kAbsoluteSlack;
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
  return std::sqrt(squared) * (1 + 0x1p-40) + kAbsoluteSlack;
}

/// Rounds up to float. Returns at least the least normal float, so that squares that underflow are
/// kept.
inline float round_up(double value) {
  if (!(value < 0x1p127)) return std::numeric_limits<float>::infinity();
  const float rounded = static_cast<float>(std::max(value * (1 + 0x1p-22), 0x1p-126));
  return rounded;
}

/// Returns a threshold: a child whose squared bound exceeds it is farther than `distance`.
inline float prune_threshold(const FloatQuery& query, double distance) {
  if (!query.usable) return std::numeric_limits<float>::infinity();
  const double reach = (distance + query.slack) * kBoundFactor;
  return round_up(reach * reach);
}

/// Returns the lower bound on the distance that a computed squared bound proves.
inline double certified(const FloatQuery& query, float bound_squared) {
  if (!query.usable) return 0;
  return std::max(0.0, std::sqrt(static_cast<double>(bound_squared)) / kBoundFactor - query.slack);
}

/// Errors of the float triangle filter. With A the longest vector from the query to a corner or
/// along a side, and u = 2^-24, every product of two such vectors is right within 5u times their
/// lengths.
///
///     edges  a2 - t (2 along - t edge2), where any t in [0, 1] gives a point of the edge: 40u A^2
///     face   a2 - (v to_b + w to_c) / |ab x ac|^2. v and w err by 23u |a| |ab| |ac|^2 and the
///            like, the divisor by 23u |ab|^2 |ac|^2: 70u |a|^2 / sine^2 of the angle at a
///
/// The kernel takes off more than that, lane by lane. Faces of a smaller sine are bounded by their
/// edges. The corners and the query are rounded relative to the block, by less than kFilterSlack
/// times (distance + block extent).
inline constexpr float kEdgeError = 64 * kUlp;
inline constexpr float kFaceError = 128 * kUlp;
inline constexpr float kFlatSine2 = 0x1p-6f;
inline constexpr double kFilterSlack = 0x1p-19;

/// Minimum extent of a filtered block: in a smaller one, squares of squares underflow.
inline constexpr float kMinFilterExtent = 0x1p-40f;

/// Returns whether float suffices to filter a block's triangles for a query.
inline bool can_filter(const FloatQuery& query, float block_extent) {
  return query.usable && block_extent >= kMinFilterExtent;
}

/// Returns an upper bound on the distance to a triangle with this filter value.
inline double filter_upper(float squared, float block_extent) {
  const double value = std::sqrt(static_cast<double>(squared));
  return value + 2 * kFilterSlack * (value + static_cast<double>(block_extent));
}

/// Returns a lower bound on the distance to a triangle with this filter value, which is itself a
/// lower bound.
inline double filter_lower(float squared, float block_extent) {
  const double value = std::sqrt(static_cast<double>(squared));
  return std::max(0.0, value - 2 * kFilterSlack * (value + static_cast<double>(block_extent)));
}

/// Returns a threshold: a triangle whose filter value exceeds it is farther than `distance`.
inline float filter_threshold(const FloatQuery& query, double distance, float block_extent) {
  if (!can_filter(query, block_extent)) return std::numeric_limits<float>::infinity();
  const double reach = distance + kFilterSlack * (distance + static_cast<double>(block_extent));
  return round_up(reach * reach);
}

}  // namespace planetree::octree
