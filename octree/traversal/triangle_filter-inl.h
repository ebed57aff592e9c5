// Finds the triangles that may be nearer than a limit, in float. octree/traversal/bounds.h derives
// the errors.

#if defined(PLANETREE_OCTREE_TRIANGLE_FILTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_TRIANGLE_FILTER_INL_H_
#undef PLANETREE_OCTREE_TRIANGLE_FILTER_INL_H_
#else
#define PLANETREE_OCTREE_TRIANGLE_FILTER_INL_H_
#endif

#include <cstddef>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/wide_floats-inl.h"
#include "octree/page/frame.h"
#include "octree/page/frame_lanes-inl.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/nearby_lists.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Returns the squared distance from the query to a segment.
//
// p2     squared distance of the segment's start
// along  dot product of the edge and the vector from the start to the query
// edge2  squared length of the edge
//
// All arguments are products of the triangle's sides, which its three segments share.
// kFilterEdgeError covers their cancellation.
HWY_INLINE TriangleFloats segment_squared(TriangleFloats p2, TriangleFloats along,
                                          TriangleFloats edge2) {
  const TriangleTag d;
  const TriangleFloats least = hn::Set(d, kMinFloatNormal);
  const TriangleFloats one = hn::Set(d, 1.0f);
  const TriangleFloats t =
      hn::Min(hn::Max(hn::Div(along, hn::Max(edge2, least)), hn::Zero(d)), one);
  return hn::Sub(p2, hn::Mul(t, hn::Sub(hn::Add(along, along), hn::Mul(t, edge2))));
}

// Bounds on the squared distances of triangles. They hold but for the rounding of the corners,
// which kFilterPositionSlack covers.
struct TriangleBounds {
  TriangleFloats lower;  // 0 where float cannot bound it
  TriangleFloats upper;
};

// Returns the lower bound for a face too flat for float. The face lies within its height of its
// edges.
//
// edges     lower bound of the squared distances of its edges
// whole     |ab x ac|^2
// sides     |ab|^2 |ac|^2
// longest2  squared length of the longest side
HWY_INLINE TriangleFloats flat_lower(TriangleFloats edges, TriangleFloats whole,
                                     TriangleFloats sides, TriangleFloats longest2) {
  const TriangleTag d;
  const TriangleFloats zero = hn::Zero(d);
  const TriangleFloats uncertainty = hn::Add(hn::Mul(sides, hn::Set(d, kFilterDeterminantError)),
                                             hn::Set(d, kFilterDeterminantUnderflow));
  const TriangleFloats rise =
      hn::Div(hn::Sqrt(hn::Add(hn::Max(whole, zero), uncertainty)), hn::Sqrt(longest2));
  const TriangleFloats flat = hn::Max(hn::Sub(hn::Sqrt(edges), rise), zero);
  return hn::IfThenElseZero(hn::Gt(longest2, hn::Set(d, kFilterMinSide2)), hn::Mul(flat, flat));
}

// Returns bounds for triangles given by the vectors from the query to their corners.
HWY_INLINE TriangleBounds triangle_bounds(const TriangleVectors& a, const TriangleVectors& b,
                                          const TriangleVectors& c) {
  const TriangleTag d;
  const TriangleFloats zero = hn::Zero(d);
  const TriangleVectors ab = sub(b, a), ac = sub(c, a);
  const TriangleFloats a2 = dot(a, a), ab2 = dot(ab, ab), ac2 = dot(ac, ac), ab_ac = dot(ab, ac);
  const TriangleFloats to_b = hn::Neg(dot(a, ab)), to_c = hn::Neg(dot(a, ac));
  // The third side and its start, from the products of the other sides.
  const TriangleFloats b2 = hn::Sub(hn::Add(a2, ab2), hn::Add(to_b, to_b));
  const TriangleFloats bc2 = hn::Sub(hn::Add(ab2, ac2), hn::Add(ab_ac, ab_ac));
  const TriangleFloats b_to_c = hn::Sub(hn::Add(to_c, ab2), hn::Add(to_b, ab_ac));
  const TriangleFloats edges =
      hn::Min(hn::Min(segment_squared(a2, to_b, ab2), segment_squared(a2, to_c, ac2)),
              segment_squared(b2, b_to_c, bc2));
  const TriangleFloats edge_error =
      hn::Mul(hn::Add(a2, hn::Add(ab2, ac2)), hn::Set(d, kFilterEdgeError));

  const TriangleFloats sides = hn::Mul(ab2, ac2);
  const TriangleFloats whole = hn::Sub(sides, hn::Mul(ab_ac, ab_ac));
  const TriangleFloats v = hn::Sub(hn::Mul(ac2, to_b), hn::Mul(ab_ac, to_c));
  const TriangleFloats w = hn::Sub(hn::Mul(ab2, to_c), hn::Mul(ab_ac, to_b));
  const auto inside =
      hn::And(hn::And(hn::Gt(v, zero), hn::Gt(w, zero)), hn::Lt(hn::Add(v, w), whole));
  const TriangleFloats inverse = hn::Div(hn::Set(d, 1.0f), whole);
  // Divides first, because products of three short sides underflow.
  const TriangleFloats face =
      hn::Sub(a2, hn::Add(hn::Mul(hn::Mul(v, inverse), to_b), hn::Mul(hn::Mul(w, inverse), to_c)));
  const TriangleFloats face_error =
      hn::Mul(hn::Mul(a2, hn::Set(d, kFilterFaceError)), hn::Mul(sides, inverse));

  const TriangleFloats squared = hn::IfThenElse(inside, face, edges);
  const TriangleFloats error = hn::IfThenElse(inside, face_error, edge_error);
  const TriangleFloats lower = hn::Max(hn::Sub(squared, error), zero);
  const TriangleFloats upper = hn::Add(squared, error);
  const auto is_regular = hn::And(hn::Ge(whole, hn::Mul(hn::Set(d, kFilterMinSine2), sides)),
                                  hn::Ge(whole, hn::Set(d, kFilterMinDeterminant)));
  if (hn::AllTrue(d, is_regular)) return {lower, upper};
  const TriangleFloats least = hn::Max(hn::Sub(edges, edge_error), zero);
  const TriangleFloats flat = flat_lower(least, whole, sides, hn::Max(hn::Max(ab2, ac2), bc2));
  return {hn::IfThenElse(is_regular, lower, flat),
          hn::IfThenElse(is_regular, upper, hn::Add(edges, edge_error))};
}

// Returns squared distances to the boxes of triangles given in the same way, at a fifth of the
// cost. They are no greater than those of the triangles but for rounding, which
// kFilterPositionSlack covers.
HWY_INLINE TriangleFloats box_bounds(const TriangleVectors& a, const TriangleVectors& b,
                                     const TriangleVectors& c) {
  const TriangleFloats zero = hn::Zero(TriangleTag());
  const auto gap = [&](TriangleFloats u, TriangleFloats v, TriangleFloats w) {
    const TriangleFloats lower = hn::Min(hn::Min(u, v), w), upper = hn::Max(hn::Max(u, v), w);
    return hn::Max(hn::Max(lower, hn::Neg(upper)), zero);
  };
  const TriangleVectors gaps{gap(a.x, b.x, c.x), gap(a.y, b.y, c.y), gap(a.z, b.z, c.z)};
  return dot(gaps, gaps);
}

// The vector from a point to the query, rounded to float.
struct FloatOffset {
  FloatOffset(const Point& query, const Point& from)
      : at{static_cast<float>(query.x() - from.x()), static_cast<float>(query.y() - from.y()),
           static_cast<float>(query.z() - from.z())} {}
  const float at[3];
};

// The triangles of a list, relative to a query.
class NearbyTriangleLanes {
 public:
  HWY_INLINE NearbyTriangleLanes(const NearbyTriangles& list, const float (&query)[3])
      : list_(list),
        query_{hn::Set(TriangleTag(), query[0]), hn::Set(TriangleTag(), query[1]),
               hn::Set(TriangleTag(), query[2])} {}

  HWY_INLINE TriangleVectors corner(std::size_t k, std::size_t i) const {
    const TriangleTag d;
    const TriangleVectors at{hn::Load(d, list_.row(k, 0) + i), hn::Load(d, list_.row(k, 1) + i),
                             hn::Load(d, list_.row(k, 2) + i)};
    return sub(at, query_);
  }

 private:
  const NearbyTriangles& list_;
  const TriangleVectors query_;
};

// Result of filtering up to kMaxBlockTriangles triangles.
struct FilteredTriangles {
  HWY_ALIGN float squared[kMaxBlockTriangles];  // lower bounds
  unsigned near;    // a bit for each triangle whose bound is not above the limit
  float min_upper;  // minimum of TriangleBounds::upper over `near`
};

// Filters `count` triangles. Lanes behind the last triangle must repeat one.
template <class Triangles>
HWY_INLINE void filter_triangles(const Triangles& triangles, std::size_t count, float limit,
                                 FilteredTriangles& filtered) {
  const TriangleTag d;
  const TriangleFloats none = hn::Set(d, std::numeric_limits<float>::infinity());
  TriangleFloats least = none;
  unsigned near = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const TriangleVectors a = triangles.corner(0, i), b = triangles.corner(1, i),
                          c = triangles.corner(2, i);
    // Fast path: most triangles of a block are too far away for more than the box test.
    const auto beyond = hn::Gt(box_bounds(a, b, c), hn::Set(d, limit));
    if (hn::AllTrue(d, beyond)) continue;
    const TriangleBounds bounds = triangle_bounds(a, b, c);
    hn::Store(bounds.lower, d, filtered.squared + i);
    // Excludes all far lanes, so that the result does not depend on the width of a register.
    const auto far = hn::Or(beyond, hn::Gt(bounds.lower, hn::Set(d, limit)));
    least = hn::Min(least, hn::IfThenElse(far, none, bounds.upper));
    near |= mask_bits(d, hn::Not(far)) << i;
  }
  filtered.near = near & (~0u >> (32 - count));
  filtered.min_upper = hn::GetLane(hn::MinOfLanes(d, least));
}

// Filters a block of this layout. Not forced inline, so that the block's vertices stay in
// registers.
template <unsigned kStride, bool kCompact>
void filter_block_of(const BlockHeader& block, const float (&query)[3], float limit,
                     FilteredTriangles& filtered) {
  filter_triangles(BlockTriangles<kStride, kCompact>(block, query), block.triangle_count, limit,
                   filtered);
}

// Filters a block. `query` is relative to vertex 0.
HWY_INLINE void filter_block(const BlockHeader& block, const float (&query)[3], float limit,
                             FilteredTriangles& filtered) {
  by_layout(block, [&]<unsigned kStride, bool kCompact>() {
    filter_block_of<kStride, kCompact>(block, query, limit, filtered);
  });
}

// Returns those of the first `count` triangles that are within a lower limit than the filter's.
// Lanes not in filtered.near may hold anything.
HWY_INLINE unsigned near_triangles(const FilteredTriangles& filtered, std::size_t count,
                                   float limit) {
  const TriangleTag d;
  unsigned near = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d))
    near |= bits_not_above(hn::Load(d, filtered.squared + i), limit) << i;
  return near & filtered.near;
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#endif
