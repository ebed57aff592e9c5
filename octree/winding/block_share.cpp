#include "octree/winding/block_share.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/winding/block_share.cpp"
#include <hwy/foreach_target.h>

#include <bit>
#include <cmath>
#include <cstddef>

#include "octree/geometry/angles.h"
#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/triangle_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

// Unit vectors whose angles are half of the solid angles of triangles, with what is known of them.
struct HalfAngles {
  alignas(kTrianglesAtOnce * sizeof(double)) double cosine[kMaxBlockTriangles];
  alignas(kTrianglesAtOnce * sizeof(double)) double sine[kMaxBlockTriangles];
  alignas(kTrianglesAtOnce * sizeof(double)) double tangent[kMaxBlockTriangles];  // magnitude
  alignas(kTrianglesAtOnce * sizeof(double)) double error[kMaxBlockTriangles];    // of the share
  unsigned certain = 0;  // certain and at most 45 degrees, one bit each
};

// Computes as many half angles as a vector holds, as half_angle_in_double() does.
HWY_INLINE void find_vector(const TriangleRows<kMaxBlockTriangles>& rows, std::size_t lane,
                            const Doubles3& point, HalfAngles& found) {
  const DoubleTag d;
  const auto corner = [&](std::size_t k) {
    return Doubles3{hn::Load(d, rows.at[k][0] + lane), hn::Load(d, rows.at[k][1] + lane),
                    hn::Load(d, rows.at[k][2] + lane)};
  };
  const Doubles3 a = corner(0) - point, b = corner(1) - point, c = corner(2) - point;
  const Doubles a2 = dot(a, a), b2 = dot(b, b), c2 = dot(c, c);
  const auto in_range = hn::And(hn::Gt(hn::Min(hn::Min(a2, b2), c2), hn::Set(d, kMinAngleLength2)),
                                hn::Lt(hn::Max(hn::Max(a2, b2), c2), hn::Set(d, kMaxAngleLength2)));
  const Doubles a1 = hn::Sqrt(a2), b1 = hn::Sqrt(b2), c1 = hn::Sqrt(c2);
  const Doubles size = hn::Mul(hn::Mul(a1, b1), c1);
  const Doubles width =
      hn::Add(hn::Add(hn::Add(size, hn::Mul(dot(a, b), c1)), hn::Mul(dot(b, c), a1)),
              hn::Mul(dot(c, a), b1));
  const Doubles height = dot(a, cross(b, c));
  const Doubles error = hn::Mul(hn::Set(d, kHalfAngleError), size);
  const Doubles length = hn::Sqrt(hn::Add(hn::Mul(width, width), hn::Mul(height, height)));
  const Doubles above = hn::Abs(height);
  const auto precise =
      hn::And(hn::Gt(above, error), hn::Lt(error, hn::Mul(hn::Set(d, kMaxHalfAngleError), length)));
  const auto certain = hn::And(hn::And(in_range, precise), hn::Le(above, width));
  hn::Store(hn::Div(width, length), d, found.cosine + lane);
  hn::Store(hn::Div(height, length), d, found.sine + lane);
  hn::Store(hn::Div(above, width), d, found.tangent + lane);
  hn::Store(hn::Mul(hn::Div(error, hn::Sub(length, error)), hn::Set(d, kAsinOverTwoPi)), d,
            found.error + lane);
  found.certain |= mask_bits(d, certain) << lane;
}

// Adds up angles by multiplying unit vectors, in the order of the triangles.
BlockShare sum_of(const HalfAngles& angles, unsigned all) {
  constexpr double kOverTwoPi = 0x1.45f306dc9c883p-3;
  // The tangents of the angles of one product sum to at most this. So the angles do, to less than
  // pi.
  constexpr double kMaxTangents = 3;
  BlockShare share;
  share.unsure = all & ~angles.certain;
  double cosine = 1, sine = 0, tangents = 0;
  const auto take_angle = [&] {
    const double angle = angle_of(cosine, std::fabs(sine)) * kOverTwoPi;
    share.value += sine < 0 ? -angle : angle;
    share.error += kAngleError;
    cosine = 1;
    sine = tangents = 0;
  };
  for (unsigned left = all & angles.certain; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(left));
    if (tangents + angles.tangent[i] > kMaxTangents) take_angle();
    const double x = angles.cosine[i], y = angles.sine[i];
    const double turned = cosine * x - sine * y;
    sine = cosine * y + sine * x;
    cosine = turned;
    tangents += angles.tangent[i];
    share.error += angles.error[i] + kTurnError;
  }
  take_angle();
  return share;
}

BlockShare share_on_target(const Point& point, const BlockView& block) {
  TriangleRows<kMaxBlockTriangles> rows;
  const unsigned count = block.triangle_count();
  for (unsigned i = 0; i < count; ++i) rows.set(i, block.triangle(i));
  const DoubleTag d;
  const Doubles3 from{hn::Set(d, point.x()), hn::Set(d, point.y()), hn::Set(d, point.z())};
  for (std::size_t i = count; i % kTrianglesAtOnce != 0; ++i) rows.copy(0, i);
  HalfAngles angles;
  for (std::size_t lane = 0; lane < count; lane += hn::Lanes(d))
    find_vector(rows, lane, from, angles);
  return sum_of(angles, (1U << count) - 1);
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(share_on_target);

BlockShare block_share(const Point& point, const BlockView& block) noexcept {
  return HWY_DYNAMIC_DISPATCH(share_on_target)(point, block);
}

}  // namespace planetree::octree
#endif
