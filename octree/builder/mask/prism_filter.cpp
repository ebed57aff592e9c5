#include "octree/builder/mask/prism_filter.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/builder/mask/prism_filter.cpp"
#include <hwy/foreach_target.h>

#include <cassert>
#include <cmath>

#include "octree/page/frame_lanes-inl.h"

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

/// Twice and four times the limits of HeightField, so that errors of float do not matter. A normal
/// must be this many times as long as its error: 2^-6 of it is below the step from 2^-3 to 2^-4.
constexpr float kPrismFilterRise = 0x1p-3f;
constexpr float kPrismFilterSine = 0x1p-10f;
constexpr float kPrismFilterNormal = 0x1p6f;

class PrismLanes {
 public:
  HWY_INLINE PrismLanes(const FloatPrism& prism, float error) : prism_(prism), error_(error) {}

  template <class Triangles>
  HWY_INLINE PrismTriangles look_at(const Triangles& triangles, unsigned count) const {
    assert(count > 0);
    PrismTriangles found;
    for (unsigned i = 0; i < count; i += static_cast<unsigned>(hn::Lanes(TriangleTag())))
      add(rotated(triangles.corner(0, i)), rotated(triangles.corner(1, i)),
          rotated(triangles.corner(2, i)), i, found);
    const unsigned all = ~0U >> (32 - count);
    return {found.met & all, found.rising & all, found.middle & all};
  }

 private:
  HWY_INLINE TriangleVectors rotated(const TriangleVectors& at) const {
    const TriangleTag d;
    const auto along = [&](const std::array<float, 3>& row) {
      return dot(at, {hn::Set(d, row[0]), hn::Set(d, row[1]), hn::Set(d, row[2])});
    };
    return {along(prism_.rotated[0]), along(prism_.rotated[1]), along(prism_.rotated[2])};
  }

  HWY_INLINE void add(const TriangleVectors& a, const TriangleVectors& b, const TriangleVectors& c,
                      unsigned first, PrismTriangles& found) const {
    const TriangleTag d;
    const auto least = [](TriangleFloats u, TriangleFloats v, TriangleFloats w) {
      return hn::Min(hn::Min(u, v), w);
    };
    const auto greatest = [](TriangleFloats u, TriangleFloats v, TriangleFloats w) {
      return hn::Max(hn::Max(u, v), w);
    };
    const TriangleVectors lower{least(a.x, b.x, c.x), least(a.y, b.y, c.y), least(a.z, b.z, c.z)};
    const TriangleVectors upper{greatest(a.x, b.x, c.x), greatest(a.y, b.y, c.y),
                                greatest(a.z, b.z, c.z)};
    const auto reaches = [&](TriangleFloats from, TriangleFloats to, float min_at,
                             float greatest_at) {
      return hn::And(hn::Le(from, hn::Set(d, greatest_at + error_)),
                     hn::Ge(to, hn::Set(d, min_at - error_)));
    };
    const auto across = hn::And(reaches(lower.x, upper.x, prism_.lower[0], prism_.upper[0]),
                                reaches(lower.y, upper.y, prism_.lower[1], prism_.upper[1]));
    const auto met = hn::And(across, reaches(lower.z, upper.z, prism_.lower[2], prism_.upper[2]));
    const auto middle = hn::And(reaches(lower.x, upper.x, prism_.middle[0], prism_.middle[0]),
                                reaches(lower.y, upper.y, prism_.middle[1], prism_.middle[1]));
    const float clear = prism_.clear + error_;
    const auto between = hn::And(hn::Lt(upper.z, hn::Set(d, prism_.upper[2] - clear)),
                                 hn::Gt(lower.z, hn::Set(d, prism_.lower[2] + clear)));
    found.met |= mask_bits(d, met) << first;
    found.middle |= mask_bits(d, middle) << first;
    found.rising |= mask_bits(d, hn::And(between, rises(a, b, c))) << first;
  }

  HWY_INLINE hn::Mask<TriangleTag> rises(const TriangleVectors& a, const TriangleVectors& b,
                                         const TriangleVectors& c) const {
    const TriangleTag d;
    const TriangleVectors u = sub(b, a), v = sub(c, a), w = sub(c, b);
    const TriangleFloats x = hn::Sub(hn::Mul(u.y, v.z), hn::Mul(u.z, v.y));
    const TriangleFloats y = hn::Sub(hn::Mul(u.z, v.x), hn::Mul(u.x, v.z));
    const TriangleFloats z = hn::Sub(hn::Mul(u.x, v.y), hn::Mul(u.y, v.x));
    const TriangleFloats z2 = hn::Mul(z, z);
    const TriangleFloats normal2 = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), z2);
    const TriangleFloats longest2 = hn::Max(hn::Max(dot(u, u), dot(v, v)), dot(w, w));
    // Smaller squares are lost to underflow.
    const auto tiny = hn::Lt(normal2, hn::Set(d, kFilterMinDeterminant));
    const auto thin = hn::Lt(normal2, hn::Mul(hn::Mul(longest2, longest2),
                                              hn::Set(d, kPrismFilterSine * kPrismFilterSine)));
    const float lost = kPrismFilterNormal * error_;
    const auto lost_to_rounding = hn::Lt(normal2, hn::Mul(longest2, hn::Set(d, lost * lost)));
    const auto flat = hn::Lt(z2, hn::Mul(normal2, hn::Set(d, kPrismFilterRise * kPrismFilterRise)));
    const auto other_way = hn::Lt(z, hn::Zero(d));
    return hn::Not(hn::Or(hn::Or(hn::Or(tiny, thin), hn::Or(lost_to_rounding, flat)), other_way));
  }

  const FloatPrism& prism_;
  const float error_;
};

PrismTriangles look_on_target(const BlockHeader& block, const FloatPrism& prism,
                              const float (&origin)[3], float error) {
  const PrismLanes lanes(prism, error);
  const unsigned count = block.triangle_count;
  return by_layout(block, [&]<unsigned kStride, bool kCompact>() {
    return lanes.look_at(BlockTriangles<kStride, kCompact>(block, origin), count);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(look_on_target);

namespace {

/// Errors of coordinates in a prism's frame are below this share of the block's reach from the
/// origin. They come from the rounding of a vertex, two differences, the rows, three products and
/// two sums: below 16 * 2^-24; doubled.
constexpr double kPrismFilterError = 0x1p-19;
/// For blocks so small that the squares from which their extents are found underflow.
constexpr double kPrismFilterMinError = 0x1p-60;

}  // namespace

PrismTriangles classify_triangles(const BlockView& block, const FloatPrism& prism,
                                  const Point& origin) noexcept {
  const Point way = origin - block.vertex(0);
  const float seen_from_first[3] = {static_cast<float>(way.x()), static_cast<float>(way.y()),
                                    static_cast<float>(way.z())};
  const float error = static_cast<float>(
      kPrismFilterError * (way.norm() + double{block.header().extent}) + kPrismFilterMinError);
  return HWY_DYNAMIC_DISPATCH(look_on_target)(block.header(), prism, seen_from_first, error);
}

}  // namespace planetree::octree
#endif
