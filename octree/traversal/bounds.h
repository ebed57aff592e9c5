#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "octree/geometry/triangle_distance.h"
#include "octree/page/child_box.h"
#include "octree/page/frame.h"

/// Lower bounds on the distance to what a child box and its bounding planes
/// enclose, in float, and how far to trust them.
///
/// With p the query, c the box centre, n the slab's normal and u = 2^-24:
///
///   box    d >= distance from p to the box
///   disc   h = n.(p-c); s = max(0, slab_lower - h, h - slab_upper);
///          t = max(0, sqrt(|p-c|^2 - h^2) - radius);  d >= sqrt(s^2 + t^2)
///
/// The disc is ours, after the bounding planes of the EBP-octree (section 3):
/// a slab alone does not know where its planes end, a disc does.
///
/// Errors. Rounding p to float moves the query by at most sqrt(3) u |p|. Box
/// bounds then err by a factor (1 + 4u). For the disc, with D = |p-c| <= d + r
/// (r the box diagonal, for c may be rounded to a corner), h errs by 8uD: the
/// share 8ud is a factor on d, the share 8ur is more than paid by what is added
/// to the stored offsets (kPlaneSlack). |p-c|^2 - h^2
/// cancels, so that kCancellation * D^2 is taken off first, which is more than
/// its rounding (24u D^2) and the normal's own (8u D^2) together. So every
/// computed bound b obeys  b <= d (1 + 16u) + sqrt(3) u |p|,  and comparing it
/// with a threshold inflated by that much never drops a child that matters.
namespace planetree::octree {

inline constexpr float kUlp = 0x1p-24f;
inline constexpr float kCancellation = 40 * kUlp;
inline constexpr double kPlaneSlack = 16 * 0x1p-24;  ///< of the box diagonal
inline constexpr double kBoundFactor = 1 + 32 * 0x1p-24;

/// Besides: doubles relative to the centre are rounded to 2^-53 of the model's
/// side, plane offsets of boxes smaller than 2^-63 underflow, and a triangle's value may
/// err by 2^-40 (octree/geometry/triangle_distance.cpp): none that is as near to within that is
/// pruned, whatever order children are visited in.
inline constexpr double kAbsoluteSlack = 0x1p-38;

/// A query rounded for the wide kernels.
struct FloatQuery {
  float x = 0, y = 0, z = 0;
  double slack = 0;     ///< what rounding may have moved it by
  bool usable = false;  ///< false: too far for float squares, nothing may be pruned

  /// A query as the wide kernels see it: relative to the model's centre.
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

/// No surface point in a box is farther than this from a query, which is relative to the
/// model's centre as the box is.
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

/// Rounds up to float; at least the least normal float, so that squares which
/// underflow are kept.
inline float round_up(double value) {
  if (!(value < 0x1p127)) return std::numeric_limits<float>::infinity();
  const float rounded = static_cast<float>(std::max(value * (1 + 0x1p-22), 0x1p-126));
  return rounded;
}

/// Bounds whose square exceeds this belong to children farther than `distance`.
inline float prune_threshold(const FloatQuery& query, double distance) {
  if (!query.usable) return std::numeric_limits<float>::infinity();
  const double reach = (distance + query.slack) * kBoundFactor;
  return round_up(reach * reach);
}

/// The distance that a computed squared bound certifies.
inline double certified(const FloatQuery& query, float bound_squared) {
  if (!query.usable) return 0;
  return std::max(0.0, std::sqrt(static_cast<double>(bound_squared)) / kBoundFactor - query.slack);
}

/// How the float triangle filter errs, with A the largest vector from the query to a corner
/// or along a side, and u = 2^-24. Every product of two such vectors, as it enters, is right
/// within 5u times their lengths.
///
///   edges  a2 - t (2 along - t edge2), of which any t in [0, 1] is a point of the edge: 40u A^2
///   face   a2 - (v to_b + w to_c) / |ab x ac|^2. v and w err by 23u |a| |ab| |ac|^2 and the
///          like, the divisor by 23u |ab|^2 |ac|^2: 70u |a|^2 / sine^2 of the angle at a
///
/// Both are paid by more than that, lane by lane; faces of a smaller sine are told by their
/// edges. The corners themselves and the query are rounded relative to the block: by less
/// than kFilterSlack times (distance + block extent).
inline constexpr float kEdgeError = 64 * kUlp;
inline constexpr float kFaceError = 128 * kUlp;
inline constexpr float kFlatSine2 = 0x1p-6f;
inline constexpr double kFilterSlack = 0x1p-19;

/// Blocks smaller than this have squares that float cannot hold.
inline constexpr float kMinFilterExtent = 0x1p-40f;

/// Whether float has squares for a query's distances to the triangles of a block.
inline bool filter_tells(const FloatQuery& query, float block_extent) {
  return query.usable && block_extent >= kMinFilterExtent;
}

/// A triangle of this filter value is at most so far away.
inline double filter_upper(float squared, float block_extent) {
  const double value = std::sqrt(static_cast<double>(squared));
  return value + 2 * kFilterSlack * (value + static_cast<double>(block_extent));
}

/// A triangle of this filter value, which is a lower bound, is at least so far away.
inline double filter_lower(float squared, float block_extent) {
  const double value = std::sqrt(static_cast<double>(squared));
  return std::max(0.0, value - 2 * kFilterSlack * (value + static_cast<double>(block_extent)));
}

/// Filter values above this belong to triangles farther than `distance`.
inline float filter_threshold(const FloatQuery& query, double distance, float block_extent) {
  if (!filter_tells(query, block_extent)) return std::numeric_limits<float>::infinity();
  const double reach = distance + kFilterSlack * (distance + static_cast<double>(block_extent));
  return round_up(reach * reach);
}

}  // namespace planetree::octree
