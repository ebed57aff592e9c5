// Tests of a node's children and of a block's triangles against a segment in float.

#ifndef PLANETREE_OCTREE_SEGMENT_KERNELS_
#define PLANETREE_OCTREE_SEGMENT_KERNELS_  // once for all targets

#include <algorithm>
#include <cmath>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// A segment in float, and all points within a margin of it. Along its longest axis it reaches from
/// `lower` to `upper`. Its coordinate on each other axis is `slope` times the coordinate on the
/// longest axis, plus an offset that is known within a range. With x within m of a point y of the
/// segment, x - y changes that offset by at most m sqrt(1 + slope^2) <= kMarginAcross m.
///
/// Errors. Let u = 2^-24, and M the greatest coordinate of the segment and of what is tested
/// against it. The rounding of slope and offset moves the segment by at most 2uM each. The product
/// errs by uM. The sum is at most 3M and errs by 3uM. The range of the offset is widened by 8uM for
/// these, and by as much again for its own rounding. So nothing that the segment meets is found
/// apart from it. This includes what it meets only by the infinitesimal steps of its ends.
struct FloatSegment {
  static constexpr double kMarginAcross = 1.5;  ///< more than sqrt(2): no slope exceeds 1

  unsigned axis = 0;
  float lower = 0, upper = 0;
  struct CrossAxis {
    unsigned axis = 0;
    float slope = 0, lowest = 0, highest = 0;
  };
  CrossAxis cross_axes[2];

  /// Makes the segment from `from` to `to`, relative to `origin`.
  ///
  /// largest  maximum coordinate, relative to `origin`, of what is tested against the segment.
  ///          What is clipped to [lower, upper] along `axis` may have larger ones.
  /// margin   what is so near to the segment counts as met
  static FloatSegment between(const Point& from, const Point& to, const Point& origin,
                              double largest, double margin = 0) {
    const Point start = from - origin, end = to - origin, way = to - from;
    FloatSegment segment;
    const Point length = way.cwiseAbs();
    segment.axis = length.x() >= length.y() ? (length.x() >= length.z() ? 0 : 2)
                                            : (length.y() >= length.z() ? 1 : 2);
    const double highest =
        std::max({largest, start.cwiseAbs().maxCoeff(), end.cwiseAbs().maxCoeff()}) + margin;
    const auto slack_of = [](double coordinate) {
      return kSegmentRounding * std::fabs(coordinate) + kAbsoluteBoundSlack;
    };
    const double first = start[segment.axis], last = end[segment.axis];
    const double lower = std::min(first, last), upper = std::max(first, last);
    segment.lower = static_cast<float>(lower - margin - slack_of(std::fabs(lower) + margin));
    segment.upper = static_cast<float>(upper + margin + slack_of(std::fabs(upper) + margin));
    const double along = way[segment.axis];
    for (unsigned i = 0; i < 2; ++i) {
      CrossAxis& cross_axes = segment.cross_axes[i];
      cross_axes.axis = (segment.axis + 1 + i) % 3;
      cross_axes.slope = along != 0 ? static_cast<float>(way[cross_axes.axis] / along) : 0;
      // Without a slope, nothing errs but the conversion of the offset.
      const double rounded = cross_axes.slope == 0 && way[cross_axes.axis] == 0
                                 ? std::fabs(start[cross_axes.axis]) + margin
                                 : highest;
      const double slack = slack_of(rounded) + kMarginAcross * margin;
      const double offset = start[cross_axes.axis] - static_cast<double>(cross_axes.slope) * first;
      cross_axes.lowest = static_cast<float>(offset - slack);
      cross_axes.highest = static_cast<float>(offset + slack);
    }
    return segment;
  }
};

}  // namespace planetree::octree
#endif

#if defined(PLANETREE_OCTREE_SEGMENT_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_SEGMENT_KERNELS_INL_H_
#undef PLANETREE_OCTREE_SEGMENT_KERNELS_INL_H_
#else
#define PLANETREE_OCTREE_SEGMENT_KERNELS_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "octree/geometry/wide_floats-inl.h"
#include "octree/page/frame.h"
#include "octree/page/frame_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Returns a bit for each child of a node that a segment may meet. Each box is clipped to the range
// of the segment along its longest axis. On the other axes, the segment is then tested over the
// clipped range only.
HWY_INLINE unsigned children_met(const Node& node, const FloatSegment& segment) {
  const FloatTag d;
  unsigned found = 0;
  for (std::size_t i = 0; i < kFanOut; i += hn::Lanes(d)) {
    const Floats first = hn::Max(lower_sides(node, segment.axis, i), hn::Set(d, segment.lower));
    const Floats last = hn::Min(upper_sides(node, segment.axis, i), hn::Set(d, segment.upper));
    auto apart = hn::Gt(first, last);
#pragma GCC unroll 2
    for (const FloatSegment::CrossAxis& cross_axes : segment.cross_axes) {
      const Floats slope = hn::Set(d, cross_axes.slope);
      const Floats a = hn::Mul(slope, first), b = hn::Mul(slope, last);
      const Floats lowest = hn::Add(hn::Min(a, b), hn::Set(d, cross_axes.lowest));
      const Floats highest = hn::Add(hn::Max(a, b), hn::Set(d, cross_axes.highest));
      apart = hn::Or(apart, hn::Gt(lower_sides(node, cross_axes.axis, i), highest));
      apart = hn::Or(apart, hn::Lt(upper_sides(node, cross_axes.axis, i), lowest));
    }
    found |= mask_bits(d, hn::Not(apart)) << i;
  }
  return found & ((1U << node.child_count) - 1);
}

// A segment in all lanes. It gives vertices codes, in which a bit is set for each side of the
// segment that a vertex is beyond.
class SegmentSides {
 public:
  HWY_INLINE explicit SegmentSides(const FloatSegment& segment)
      : along_(segment.axis),
        cross_axes_{segment.cross_axes[0].axis, segment.cross_axes[1].axis},
        lower_(hn::Set(FloatTag(), segment.lower)),
        upper_(hn::Set(FloatTag(), segment.upper)),
        first_(segment.cross_axes[0]),
        second_(segment.cross_axes[1]) {}

  // Writes the codes of `stride` vertices, in whole vectors. Float holds the vertices exactly.
  HWY_INLINE void write_codes(const float* HWY_RESTRICT vertices, unsigned stride,
                              std::uint8_t* HWY_RESTRICT codes) const {
    const FloatTag d;
    const hn::Rebind<std::uint8_t, FloatTag> bytes;
    const float* along = vertices + std::size_t{along_} * stride;
    const float* cross0 = vertices + std::size_t{cross_axes_[0]} * stride;
    const float* cross1 = vertices + std::size_t{cross_axes_[1]} * stride;
    for (std::size_t i = 0; i < stride; i += hn::Lanes(d)) {
      const Floats z = hn::Load(d, along + i);
      Ints code = hn::Or(bit_where(hn::Lt(z, lower_), 1), bit_where(hn::Gt(z, upper_), 2));
      code = hn::Or(code, first_.code(z, hn::Load(d, cross0 + i), 4));
      code = hn::Or(code, second_.code(z, hn::Load(d, cross1 + i), 16));
      hn::StoreU(hn::DemoteTo(bytes, code), bytes, codes + i);
    }
  }

 private:
  static HWY_INLINE Ints bit_where(hn::Mask<FloatTag> mask, std::int32_t bit) {
    const IntTag d;
    return hn::IfThenElseZero(hn::RebindMask(d, mask), hn::Set(d, bit));
  }

  struct CrossAxis {
    HWY_INLINE explicit CrossAxis(const FloatSegment::CrossAxis& cross_axes)
        : slope(hn::Set(FloatTag(), cross_axes.slope)),
          lowest(hn::Set(FloatTag(), cross_axes.lowest)),
          highest(hn::Set(FloatTag(), cross_axes.highest)) {}
    HWY_INLINE Ints code(Floats z, Floats at, std::int32_t bit) const {
      const Floats offset = hn::Mul(slope, z);
      return hn::Or(bit_where(hn::Lt(at, hn::Add(offset, lowest)), bit),
                    bit_where(hn::Gt(at, hn::Add(offset, highest)), 2 * bit));
    }
    Floats slope, lowest, highest;
  };

  const unsigned along_, cross_axes_[2];
  const Floats lower_, upper_;
  const CrossAxis first_, second_;
};

// Returns a bit for each triangle of a block that a segment may meet: its corners are not all
// beyond the same side of the segment.
HWY_INLINE unsigned triangles_met(const BlockHeader& block, const float* vertices,
                                  const FloatSegment& segment) {
  HWY_ALIGN std::uint8_t codes[kMaxBlockVertices];
  SegmentSides(segment).write_codes(vertices, block.stride(), codes);
  return ~corner_codes(block, codes).shared & ((1U << block.triangle_count) - 1);
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#endif
