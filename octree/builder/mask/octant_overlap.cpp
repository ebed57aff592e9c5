#include "octree/builder/mask/octant_overlap.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/builder/mask/octant_overlap.cpp"
#include <hwy/foreach_target.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <iterator>

#include "octree/geometry/cell_overlap.h"
#include "octree/geometry/wide_floats-inl.h"

#include "octree/geometry/strict_math.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

// Let R be the greatest distance of corners and sides from the middle along an axis. On an axis
// across an edge, no gap errs by more than the first share of R^2: its products have a factor below
// 2 R and one below R, each with the rounding of corners and of their differences. Along the
// normal, no gap errs by more than the second share of R^3. Rounding never reverses the order of
// two coordinates.
constexpr float kOctantEdgeError = 0x1p-18f;
constexpr float kOctantNormalError = 0x1p-14f;
// With R outside of this range, the cube of R is lost.
constexpr float kOctantMinReach = 0x1p-30f;
constexpr float kOctantMaxReach = 0x1p30f;

// How far apart boxes and triangles are on separating axes; less than 0 where they overlap.
class OverlapLanes {
 public:
  HWY_INLINE OverlapLanes(const OctantOverlap::FloatTriangles& in_float, unsigned first)
      : in_float_(in_float) {
    const TriangleTag d;
#pragma GCC unroll 3
    for (unsigned k = 0; k < 3; ++k)
#pragma GCC unroll 3
      for (unsigned axis = 0; axis < 3; ++axis)
        at_[k][axis] = hn::Load(d, in_float.corner[k][axis] + first);
  }

  HWY_INLINE void decide(unsigned first, OctantOverlap::FloatResult& float_result) {
    look_along_edges();
    look_along_normal();
    look_along_axes();
    const TriangleTag d;
    const hn::RebindToSigned<TriangleTag> di;
    const hn::Rebind<std::uint8_t, decltype(di)> bytes;
    const TriangleFloats reach = this->reach(), reach2 = hn::Mul(reach, reach);
    const TriangleFloats edge_error = hn::Mul(reach2, hn::Set(d, kOctantEdgeError));
    const TriangleFloats normal_error =
        hn::Mul(hn::Mul(reach2, reach), hn::Set(d, kOctantNormalError));
    const auto fits = hn::And(hn::Ge(reach, hn::Set(d, kOctantMinReach)),
                              hn::Le(reach, hn::Set(d, kOctantMaxReach)));
    auto touched = hn::Zero(di), unsure = hn::Zero(di);
#pragma GCC unroll 8
    for (unsigned octant = 0; octant < 8; ++octant) {
      const auto bit = hn::Set(di, 1 << octant);
      const TriangleFloats edge = edge_gap(octant), box = box_gap(octant);
      const TriangleFloats normal = normal_[octant];
      const auto apart = hn::Or(hn::Or(hn::Gt(edge, edge_error), hn::Gt(normal, normal_error)),
                                hn::Gt(box, hn::Zero(d)));
      const auto overlap =
          hn::And(hn::And(hn::Lt(edge, hn::Neg(edge_error)), hn::Lt(normal, hn::Neg(normal_error))),
                  hn::Lt(box, hn::Zero(d)));
      const auto certain = hn::And(fits, hn::Or(apart, overlap));
      const auto touches = hn::And(certain, overlap);
      touched = hn::Or(touched, hn::IfThenElseZero(hn::RebindMask(di, touches), bit));
      unsure = hn::Or(unsure, hn::IfThenZeroElse(hn::RebindMask(di, certain), bit));
    }
    hn::StoreU(hn::DemoteTo(bytes, touched), bytes, float_result.touched + first);
    hn::StoreU(hn::DemoteTo(bytes, unsure), bytes, float_result.unsure + first);
  }

 private:
  // The two halves of a box in one direction, projected to an axis with the component `along`.
  struct Halves {
    TriangleFloats least[2], greatest[2];
  };
  HWY_INLINE Halves halves(unsigned axis, TriangleFloats along) const {
    const TriangleTag d;
    const TriangleFloats lower = hn::Mul(along, hn::Set(d, in_float_.lower[axis]));
    const TriangleFloats upper = hn::Mul(along, hn::Set(d, in_float_.upper[axis]));
    const TriangleFloats zero = hn::Zero(d);
    return {{hn::Min(lower, zero), hn::Min(upper, zero)},
            {hn::Max(lower, zero), hn::Max(upper, zero)}};
  }

  static HWY_INLINE TriangleFloats gap(TriangleFloats least, TriangleFloats greatest,
                                       TriangleFloats box_least, TriangleFloats box_greatest) {
    return hn::Max(hn::Sub(least, box_greatest), hn::Sub(box_least, greatest));
  }

  HWY_INLINE void look_along_edges() {
#pragma GCC unroll 3
    for (unsigned k = 0; k < 3; ++k) {
      const auto& from = at_[k];
      const auto& to = at_[(k + 1) % 3];
      const auto& other = at_[(k + 2) % 3];
#pragma GCC unroll 3
      for (unsigned axis = 0; axis < 3; ++axis) {
        const unsigned i = (axis + 1) % 3, j = (axis + 2) % 3;
        const TriangleFloats p = hn::Sub(from[j], to[j]), q = hn::Sub(to[i], from[i]);
        const TriangleFloats at_edge = hn::Add(hn::Mul(p, from[i]), hn::Mul(q, from[j]));
        const TriangleFloats at_other = hn::Add(hn::Mul(p, other[i]), hn::Mul(q, other[j]));
        const TriangleFloats least = hn::Min(at_edge, at_other);
        const TriangleFloats greatest = hn::Max(at_edge, at_other);
        const Halves along_i = halves(i, p), along_j = halves(j, q);
#pragma GCC unroll 4
        for (unsigned half = 0; half < 4; ++half) {
          const unsigned u = half & 1, v = half >> 1;
          const TriangleFloats here =
              gap(least, greatest, hn::Add(along_i.least[u], along_j.least[v]),
                  hn::Add(along_i.greatest[u], along_j.greatest[v]));
          edge_[axis][half] = k == 0 ? here : hn::Max(edge_[axis][half], here);
        }
      }
    }
  }

  HWY_INLINE void look_along_normal() {
    const TriangleTag d;
    TriangleFloats u[3], v[3];
#pragma GCC unroll 3
    for (unsigned axis = 0; axis < 3; ++axis) {
      u[axis] = hn::Sub(at_[1][axis], at_[0][axis]);
      v[axis] = hn::Sub(at_[2][axis], at_[0][axis]);
    }
    TriangleFloats height = hn::Zero(d);
    Halves along[3];
#pragma GCC unroll 3
    for (unsigned axis = 0; axis < 3; ++axis) {
      const unsigned i = (axis + 1) % 3, j = (axis + 2) % 3;
      const TriangleFloats normal = hn::Sub(hn::Mul(u[i], v[j]), hn::Mul(u[j], v[i]));
      height = hn::Add(height, hn::Mul(normal, at_[0][axis]));
      along[axis] = halves(axis, normal);
    }
#pragma GCC unroll 8
    for (unsigned octant = 0; octant < 8; ++octant) {
      const unsigned x = octant & 1, y = octant >> 1 & 1, z = octant >> 2;
      const auto sum = [&](TriangleFloats a, TriangleFloats b, TriangleFloats c) {
        return hn::Add(hn::Add(a, b), c);
      };
      normal_[octant] =
          gap(height, height, sum(along[0].least[x], along[1].least[y], along[2].least[z]),
              sum(along[0].greatest[x], along[1].greatest[y], along[2].greatest[z]));
    }
  }

  HWY_INLINE void look_along_axes() {
    const TriangleTag d;
#pragma GCC unroll 3
    for (unsigned axis = 0; axis < 3; ++axis) {
      const TriangleFloats &a = at_[0][axis], &b = at_[1][axis], &c = at_[2][axis];
      const TriangleFloats least = hn::Min(hn::Min(a, b), c), greatest = hn::Max(hn::Max(a, b), c);
      const TriangleFloats zero = hn::Zero(d);
      box_[axis][0] = gap(least, greatest, hn::Set(d, in_float_.lower[axis]), zero);
      box_[axis][1] = gap(least, greatest, zero, hn::Set(d, in_float_.upper[axis]));
    }
  }

  HWY_INLINE TriangleFloats edge_gap(unsigned octant) const {
    TriangleFloats greatest_gap = edge_[0][octant >> 1];
    greatest_gap = hn::Max(greatest_gap, edge_[1][octant >> 2 | (octant & 1) << 1]);
    return hn::Max(greatest_gap, edge_[2][octant & 3]);
  }
  HWY_INLINE TriangleFloats box_gap(unsigned octant) const {
    return hn::Max(hn::Max(box_[0][octant & 1], box_[1][octant >> 1 & 1]), box_[2][octant >> 2]);
  }

  // Greatest distance of corners and sides from the middle along an axis.
  HWY_INLINE TriangleFloats reach() const {
    float size = 0;
#pragma GCC unroll 3
    for (unsigned axis = 0; axis < 3; ++axis)
      size = std::max({size, -in_float_.lower[axis], in_float_.upper[axis]});
    TriangleFloats greatest_gap = hn::Set(TriangleTag(), size);
    for (const auto& corner : at_)
      for (const TriangleFloats& coordinate : corner)
        greatest_gap = hn::Max(greatest_gap, hn::Abs(coordinate));
    return greatest_gap;
  }

  const OctantOverlap::FloatTriangles& in_float_;
  TriangleFloats at_[3][3];    // by corner, axis
  TriangleFloats edge_[3][4];  // on axes across edges; by axis, and by halves of the two others
  TriangleFloats normal_[8];   // by octant
  TriangleFloats box_[3][2];   // by axis, half
};

void decide_octants(const OctantOverlap::FloatTriangles& in_float, unsigned count,
                    OctantOverlap::FloatResult& float_result) {
  for (unsigned i = 0; i < count; i += static_cast<unsigned>(hn::Lanes(TriangleTag())))
    OverlapLanes(in_float, i).decide(i, float_result);
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(decide_octants);

namespace {

/// Minimum size of a cell, as a share of its distance from the origin. In smaller cells the
/// rounding of the middle in may_touch() is not far below the errors of float.
constexpr double kOctantMinCellShare = 0x1p-28;

}  // namespace

OctantOverlap::OctantOverlap(const Point& lower, const Point& middle, const Point& upper)
    : sides_{lower, middle, upper} {
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double farthest = std::max(std::fabs(lower[axis]), std::fabs(upper[axis]));
    float_decides_ = float_decides_ && upper[axis] - lower[axis] > kOctantMinCellShare * farthest;
    in_float_.lower[axis] = static_cast<float>(lower[axis] - middle[axis]);
    in_float_.upper[axis] = static_cast<float>(upper[axis] - middle[axis]);
  }
}

void OctantOverlap::add(const Triangle& triangle, unsigned octants, std::uint32_t index) {
  assert(!full());
  for (unsigned k = 0; k < 3; ++k)
    for (unsigned axis = 0; axis < 3; ++axis)
      in_float_.corner[k][axis][count_] = static_cast<float>(triangle[k][axis] - sides_[1][axis]);
  triangles_[count_] = triangle;
  indices_[count_] = index;
  octants_[count_++] = static_cast<std::uint8_t>(octants);
}

OctantOverlap::TouchedOctants OctantOverlap::take() {
  TouchedOctants certain;
  if (count_ == 0) return certain;
  FloatResult float_result{};
  if (float_decides_)
    HWY_DYNAMIC_DISPATCH(decide_octants)(in_float_, count_, float_result);
  else
    std::fill(std::begin(float_result.unsure), std::end(float_result.unsure), std::uint8_t{0xff});
  for (unsigned at = 0; at < count_; ++at) {
    unsigned touched = octants_[at] & float_result.touched[at];
    for (unsigned left = octants_[at] & float_result.unsure[at]; left != 0; left &= left - 1) {
      const auto octant = static_cast<unsigned>(std::countr_zero(left));
      if (touches(at, octant)) touched |= 1U << octant;
    }
    certain.octants[at] = static_cast<std::uint8_t>(touched);
  }
  certain.count = count_;
  certain.indices = indices_;
  count_ = 0;
  return certain;
}

bool OctantOverlap::touches(unsigned at, unsigned octant) const {
  Point lower, upper;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const unsigned half = octant >> axis & 1;
    lower[axis] = sides_[half][axis];
    upper[axis] = sides_[half + 1][axis];
  }
  return may_touch(triangles_[at], lower, upper);
}

}  // namespace planetree::octree
#endif
