// Distances from a point to several triangles at once, in double, by the method of
// octree/geometry/triangle_distance.h. Compiled once for each instruction set that Highway targets.
// Multiplications and additions are never fused and lanes are never mixed, so that all instruction
// sets compute the same bits.

#if defined(PLANETREE_OCTREE_TRIANGLE_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_TRIANGLE_KERNELS_INL_H_
#undef PLANETREE_OCTREE_TRIANGLE_KERNELS_INL_H_
#else
#define PLANETREE_OCTREE_TRIANGLE_KERNELS_INL_H_
#endif

#include <cstddef>

#include <hwy/highway.h>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/triangle_distance.h"
#include "octree/geometry/wide_floats-inl.h"
#include "octree/geometry/work_limit.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DoubleTag = hn::CappedTag<double, kTrianglesAtOnce>;
using Doubles = hn::Vec<DoubleTag>;
using DoubleMask = hn::Mask<DoubleTag>;

// A point or a vector of each triangle, one a lane.
struct Doubles3 {
  Doubles x, y, z;
};

HWY_INLINE Doubles3 operator-(const Doubles3& a, const Doubles3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Doubles3 operator-(const Doubles3& a) {
  return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)};
}
HWY_INLINE Doubles dot(const Doubles3& a, const Doubles3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Doubles3 cross(const Doubles3& a, const Doubles3& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
HWY_INLINE Doubles3 choose(DoubleMask mask, const Doubles3& yes, const Doubles3& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}

// Puts the two corners in each lane into lexicographic order.
HWY_INLINE void order_corners(Doubles3& a, Doubles3& b) {
  const auto z = hn::Lt(b.z, a.z);
  const auto yz = hn::Or(hn::Lt(b.y, a.y), hn::And(hn::Eq(b.y, a.y), z));
  const auto swapped = hn::Or(hn::Lt(b.x, a.x), hn::And(hn::Eq(b.x, a.x), yz));
  const Doubles3 first = choose(swapped, b, a);
  b = choose(swapped, a, b);
  a = first;
}

// The nearest point of the segment from u to v in each lane, at u + t (v - u).
struct NearestOnSegments {
  Doubles squared;
  Doubles t;
};

// t = 0 keeps the bits of u's distance and t = 1 takes those of v's, so that a vertex has the same
// distance from all of its edges.
HWY_INLINE NearestOnSegments nearest_on_segments(const Doubles3& to_u, Doubles to_v2,
                                                 const Doubles3& edge, Doubles edge2) {
  const DoubleTag d;
  const Doubles zero = hn::Zero(d), one = hn::Set(d, 1.0);
  const Doubles along = hn::Neg(dot(to_u, edge));
  // Selects after dividing because an edge of length zero divides by zero.
  const Doubles share = hn::IfThenElseZero(hn::Gt(along, zero), hn::Div(along, edge2));
  const auto within = hn::Lt(share, one);
  const Doubles t = hn::IfThenElse(within, share, one);
  const Doubles3 to{hn::Add(to_u.x, hn::Mul(t, edge.x)), hn::Add(to_u.y, hn::Mul(t, edge.y)),
                    hn::Add(to_u.z, hn::Mul(t, edge.z))};
  return {hn::IfThenElse(within, dot(to, to), to_v2), t};
}

// Evaluates as many triangles as a vector holds. Their coordinates are in `rows`, ordered by corner
// and axis, `stride` doubles apart. Returns a bit for each triangle whose face is too flat for
// double.
HWY_INLINE unsigned evaluate_vector(const double* HWY_RESTRICT rows, std::size_t stride,
                                    const Doubles3& query, TriangleResults& results,
                                    std::size_t lane) {
  const DoubleTag d;
  const Doubles zero = hn::Zero(d);
  const auto corner = [&](std::size_t k) {
    const double* at = rows + 3 * k * stride;
    return Doubles3{hn::Load(d, at), hn::Load(d, at + stride), hn::Load(d, at + 2 * stride)};
  };
  Doubles3 c0 = corner(0), c1 = corner(1), c2 = corner(2);
  order_corners(c0, c1);
  order_corners(c1, c2);
  order_corners(c0, c1);

  const Doubles3 to0 = c0 - query, to1 = c1 - query, to2 = c2 - query;
  const Doubles far0 = dot(to0, to0), far1 = dot(to1, to1), far2 = dot(to2, to2);
  const Doubles3 e01 = c1 - c0, e02 = c2 - c0, e12 = c2 - c1;
  const Doubles long01 = dot(e01, e01), long02 = dot(e02, e02), long12 = dot(e12, e12);

  // Each side has the number of the corner opposite to it.
  NearestOnSegments nearest = nearest_on_segments(to1, far2, e12, long12);
  Doubles side = zero;
  const auto offer = [&](const NearestOnSegments& other, double number) {
    const auto nearer = hn::Lt(other.squared, nearest.squared);
    nearest.squared = hn::IfThenElse(nearer, other.squared, nearest.squared);
    nearest.t = hn::IfThenElse(nearer, other.t, nearest.t);
    side = hn::IfThenElse(nearer, hn::Set(d, number), side);
  };
  offer(nearest_on_segments(to0, far2, e02, long02), 1);
  offer(nearest_on_segments(to0, far1, e01, long01), 2);

  // The apex is opposite to the longest side. e1 and e2 lead from it to the other corners in order.
  const auto apex1 = hn::Gt(long02, long12);
  const Doubles longest = hn::IfThenElse(apex1, long02, long12);
  const auto apex2 = hn::Gt(long01, longest);
  Doubles3 e1 = choose(apex1, -e01, e01), e2 = choose(apex1, e12, e02);
  Doubles3 to_apex = choose(apex1, to1, to0);
  Doubles long1 = long01, long2 = hn::IfThenElse(apex1, long12, long02);
  e1 = choose(apex2, -e02, e1);
  e2 = choose(apex2, -e12, e2);
  to_apex = choose(apex2, to2, to_apex);
  long1 = hn::IfThenElse(apex2, long02, long1);
  long2 = hn::IfThenElse(apex2, long12, long2);
  const Doubles apex =
      hn::IfThenElse(apex2, hn::Set(d, 2.0), hn::IfThenElseZero(apex1, hn::Set(d, 1.0)));

  const Doubles3 from_apex = -to_apex;
  const Doubles3 normal = cross(e1, e2);
  const Doubles normal2 = dot(normal, normal), sides2 = hn::Mul(long1, long2);
  const auto is_regular = hn::And(hn::Ge(normal2, hn::Mul(hn::Set(d, kMinFaceSine2), sides2)),
                                  hn::Ge(normal2, hn::Set(d, kMinFaceNormal2)));
  const Doubles v = dot(cross(from_apex, e2), normal), w = dot(cross(e1, from_apex), normal);
  const Doubles height = dot(from_apex, normal);
  // height * height would underflow above a face with short edges.
  const Doubles face = hn::Mul(hn::Div(height, normal2), height);
  const auto above = hn::And(hn::And(hn::Gt(v, zero), hn::Gt(w, zero)),
                             hn::And(hn::Lt(hn::Add(v, w), normal2), is_regular));
  const auto on_face = hn::And(above, hn::Le(face, nearest.squared));

  const Doubles farthest = hn::Max(hn::Max(far0, far1), far2);
  const Doubles inverse_sine2 =
      hn::IfThenElse(is_regular, hn::Div(sides2, normal2), hn::Set(d, 1.0));
  const Doubles error =
      hn::Add(hn::Mul(hn::Set(d, kValueErrorFactor), hn::Sqrt(hn::Mul(farthest, inverse_sine2))),
              hn::Set(d, kUnresolvedLength));
  hn::Store(hn::IfThenElse(on_face, face, nearest.squared), d, results.squared + lane);
  hn::Store(error, d, results.error + lane);
  hn::Store(hn::IfThenElse(on_face, apex, side), d, results.number + lane);
  hn::Store(hn::IfThenElse(on_face, hn::Div(v, normal2), nearest.t), d, results.first + lane);
  hn::Store(hn::IfThenElse(on_face, hn::Div(w, normal2), hn::Set(d, TriangleResult::kOnSide)), d,
            results.second + lane);
  return mask_bits(d, hn::Not(is_regular));
}

// Evaluates kTrianglesAtOnce triangles of TriangleRows, beginning with the one that `rows` points
// to. Returns a bit for each triangle whose face is too flat for double; refine_flat() evaluates
// those again.
HWY_INLINE unsigned evaluate_triangles(const double* HWY_RESTRICT rows, std::size_t stride,
                                       const Point& query, TriangleResults& results) {
  const DoubleTag d;
  const Doubles3 q{hn::Set(d, query.x()), hn::Set(d, query.y()), hn::Set(d, query.z())};
  unsigned flat = 0;
  for (std::size_t lane = 0; lane < kTrianglesAtOnce; lane += hn::Lanes(d))
    flat |= evaluate_vector(rows + lane, stride, q, results, lane) << lane;
  return flat;
}

// Evaluates flat faces again. Returns a bit for each that `work` refuses.
template <class Work>
HWY_NOINLINE unsigned refine_flat_faces(const TriangleView& triangles, unsigned flat,
                                        const Point& query, Work& work, TriangleResults& results) {
  unsigned refused = 0;
  for (; flat != 0; flat &= flat - 1) {
    const unsigned triangle = flat & (0U - flat);
    const auto lane = static_cast<unsigned>(std::countr_zero(flat));
    if (has_equal_corners(triangles.triangle(lane))) continue;
    if (work.take(WorkUnits::kFlatFace))
      refine_flat(query, triangles, triangle, results);
    else
      refused |= triangle;
  }
  return refused;
}

// Evaluates those of kTrianglesAtOnce triangles that have a bit in `selected`. Charges `work`, a
// WorkLimit or a TraversalWork, for flat faces. Returns a bit for each triangle that it refuses,
// whose result has no meaning.
template <class Work>
HWY_INLINE unsigned evaluate_selected(const TriangleView& triangles, unsigned selected,
                                      const Point& query, Work& work, TriangleResults& results) {
  const unsigned flat =
      evaluate_triangles(triangles.at, triangles.stride, query, results) & selected;
  return flat == 0 ? 0 : refine_flat_faces(triangles, flat, query, work, results);
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#endif
