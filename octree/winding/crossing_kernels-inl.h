// Tests in double which of several triangles a segment passes through. Answers depend only on
// signs that are certain in spite of rounding; other triangles are reported as unsure.

#if defined(PLANETREE_OCTREE_CROSSING_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_CROSSING_KERNELS_INL_H_
#undef PLANETREE_OCTREE_CROSSING_KERNELS_INL_H_
#else
#define PLANETREE_OCTREE_CROSSING_KERNELS_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/predicates.h"
#include "octree/geometry/triangle_distance.h"
#include "octree/geometry/triangle_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

// Sets of up to kTrianglesAtOnce triangles, one bit each. A triangle in none of them is certainly
// not crossed, and the segment's start is certainly not on it.
struct CrossedTriangles {
  unsigned forward = 0;   // crossing() is 1
  unsigned backward = 0;  // crossing() is -1
  unsigned unsure = 0;    // left to exact predicates
};

// The greatest magnitude of a coordinate.
HWY_INLINE Doubles largest(const Doubles3& a) {
  return hn::Max(hn::Max(hn::Abs(a.x), hn::Abs(a.y)), hn::Abs(a.z));
}

// The sign of a . (b x c), where it is certain. Components of the three vectors err by one rounding
// each. `size` is the product of the vectors' greatest components.
struct CertainSign {
  DoubleMask positive, negative;
};
HWY_INLINE CertainSign certain_sign(Doubles determinant, Doubles size) {
  const DoubleTag d;
  const Doubles error =
      hn::Add(hn::Mul(size, hn::Set(d, kCrossingDeterminantError)), hn::Set(d, kCrossingUnderflow));
  return {hn::Gt(determinant, error), hn::Lt(determinant, hn::Neg(error))};
}

// Tests as many triangles of `rows` as a vector holds, from `lane` on, against a segment.
HWY_INLINE CrossedTriangles cross_vector(const TriangleRows<kTrianglesAtOnce>& rows,
                                         std::size_t lane, const Doubles3& from,
                                         const Doubles3& to) {
  const DoubleTag d;
  const auto corner = [&](std::size_t k) {
    return Doubles3{hn::Load(d, rows.at[k][0] + lane), hn::Load(d, rows.at[k][1] + lane),
                    hn::Load(d, rows.at[k][2] + lane)};
  };
  const Doubles3 p = corner(0), q = corner(1), r = corner(2);
  const Doubles3 a = p - from, b = q - from, c = r - from, way = to - from;
  const Doubles3 e1 = q - p, e2 = r - p;
  const Doubles3 normal = cross(e1, e2), beyond = p - to;
  const Doubles size_a = largest(a), size_b = largest(b), size_c = largest(c);
  const Doubles faces = hn::Mul(largest(e1), largest(e2)), length = largest(way);

  // Positive where the end of the segment is behind the triangle's plane.
  const CertainSign start = certain_sign(dot(a, normal), hn::Mul(faces, size_a));
  const CertainSign end = certain_sign(dot(beyond, normal), hn::Mul(faces, largest(beyond)));
  const auto edge = [&](const Doubles3& u, const Doubles3& v, Doubles sizes) {
    return certain_sign(dot(way, cross(v, u)), hn::Mul(length, sizes));
  };
  const CertainSign ab = edge(a, b, hn::Mul(size_a, size_b));
  const CertainSign bc = edge(b, c, hn::Mul(size_b, size_c));
  const CertainSign ca = edge(c, a, hn::Mul(size_c, size_a));

  const auto same_side =
      hn::Or(hn::And(start.positive, end.positive), hn::And(start.negative, end.negative));
  const auto beside = hn::And(hn::Or(hn::Or(ab.positive, bc.positive), ca.positive),
                              hn::Or(hn::Or(ab.negative, bc.negative), ca.negative));
  const auto through = hn::Or(hn::And(hn::And(ab.positive, bc.positive), ca.positive),
                              hn::And(hn::And(ab.negative, bc.negative), ca.negative));
  const auto forward = hn::And(through, hn::And(start.positive, end.negative));
  const auto backward = hn::And(through, hn::And(start.negative, end.positive));
  const auto certain = hn::Or(hn::Or(same_side, beside), hn::Or(forward, backward));
  return {mask_bits(d, forward), mask_bits(d, backward), mask_bits(d, hn::Not(certain))};
}

HWY_INLINE CrossedTriangles cross_triangles(const TriangleRows<kTrianglesAtOnce>& rows,
                                            const PerturbedSegment& segment) {
  const DoubleTag d;
  const auto all = [&](const Point& point) {
    return Doubles3{hn::Set(d, point.x()), hn::Set(d, point.y()), hn::Set(d, point.z())};
  };
  const Doubles3 from = all(segment.from), to = all(segment.to);
  CrossedTriangles found;
  for (std::size_t lane = 0; lane < kTrianglesAtOnce; lane += hn::Lanes(d)) {
    const CrossedTriangles some = cross_vector(rows, lane, from, to);
    found.forward |= some.forward << lane;
    found.backward |= some.backward << lane;
    found.unsure |= some.unsure << lane;
  }
  return found;
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#endif
