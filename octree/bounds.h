#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

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
/// err by 2^-40 (octree/triangle_distance.cpp): none that is as near to within that is
/// pruned, whatever order children are visited in.
inline constexpr double kAbsoluteSlack = 0x1p-38;

/// A query rounded for the wide kernels.
struct FloatQuery {
  float x = 0, y = 0, z = 0;
  double slack = 0;     ///< what rounding may have moved it by
  bool usable = false;  ///< false: too far for float squares, nothing may be pruned

  /// `x`, `y`, `z` are relative to the model's centre.
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

/// How much the float triangle filter may err, as a share of (distance + block
/// extent): its worst part, the inside test of a face whose angle at corner 0
/// has a sine of 1/16, costs 3 * 12 * 16 u times the farthest corner, which is
/// at most distance + 2 extents away.
inline constexpr double kFilterSlack = 0x1p-13;

/// Blocks smaller than this have squares that float cannot hold.
inline constexpr float kLeastFilterExtent = 0x1p-40f;

/// A triangle of this filter value is at most so far away.
inline double filter_upper(float squared, float block_extent) {
  const double value = std::sqrt(static_cast<double>(squared));
  return (value + kFilterSlack * static_cast<double>(block_extent)) * (1 + 2 * kFilterSlack);
}

/// Filter values above this belong to triangles farther than `distance`.
inline float filter_threshold(const FloatQuery& query, double distance, float block_extent) {
  if (!query.usable || block_extent < kLeastFilterExtent)
    return std::numeric_limits<float>::infinity();
  const double reach = distance + kFilterSlack * (distance + static_cast<double>(block_extent));
  return round_up(reach * reach);
}

}  // namespace planetree::octree
