#include "octree/geometry/predicates.h"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>
#include <utility>

#include "octree/geometry/wide_numbers.h"

namespace planetree::octree {
namespace {

namespace mp = boost::multiprecision;

/// Integer of fixed size, stored without allocation.
template <unsigned kBits>
using Whole =
    mp::number<mp::cpp_int_backend<kBits, kBits, mp::signed_magnitude, mp::unchecked, void>,
               mp::et_off>;

/// Coordinates are multiples of 2^-1074 and below 2^302; differences of two are below 2^1377 units.
/// A determinant is a sum of six products of three differences: below 2^4134.
using LargeWhole = Whole<4160>;
/// Most coordinates are of similar size. Coordinates below 2^126 have differences below 2^127 and
/// determinants below 2^384; areas of 2^20 corners are below 2^276.
using SmallWhole = Whole<384>;
constexpr int kSmallBits = 126;

/// The unit of some points: the largest power of two that divides all their coordinates.
class CommonUnit {
 public:
  template <std::size_t kCount>
  explicit CommonUnit(const std::array<const Point*, kCount>& points) {
    for (const Point* point : points) add(*point);
  }
  explicit CommonUnit(std::span<const Vec3> points) {
    for (const Vec3& point : points) add({point.x, point.y, point.z});
  }

  /// Returns whether all coordinates are below 2^kSmallBits units.
  bool small() const { return max_ - exponent_ <= kSmallBits - 53; }

  template <class Number>
  std::array<Number, 3> difference(const Point& to, const Point& from) const {
    std::array<Number, 3> result;
    for (unsigned axis = 0; axis < 3; ++axis)
      result[axis] = whole<Number>(to[axis]) - whole<Number>(from[axis]);
    return result;
  }

 private:
  void add(const Point& point) {
    for (const double value : point)
      if (const DoubleParts parts(value); parts.mantissa != 0) {
        exponent_ = std::min(exponent_, parts.exponent);
        max_ = std::max(max_, parts.exponent);
      }
  }
  template <class Number>
  Number whole(double value) const {
    const DoubleParts parts(value);
    Number result = parts.mantissa;
    if (parts.mantissa != 0) result <<= static_cast<unsigned>(parts.exponent - exponent_);
    return result;
  }

  int exponent_ = 2046;
  int max_ = 0;
};

template <class Number>
int orientation_sign(const CommonUnit& unit, const Point& a, const Point& b, const Point& c,
                     const Point& d) {
  const auto u = unit.difference<Number>(b, a), v = unit.difference<Number>(c, a),
             w = unit.difference<Number>(d, a);
  const Number volume = u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
                        u[2] * (v[0] * w[1] - v[1] * w[0]);
  return volume.sign();
}

template <class Number>
int area_sign(const CommonUnit& unit, const Point& a, const Point& b, const Point& c,
              unsigned axis) {
  const auto u = unit.difference<Number>(b, a), v = unit.difference<Number>(c, a);
  const unsigned i = (axis + 1) % 3, j = (axis + 2) % 3;
  const Number area = u[i] * v[j] - u[j] * v[i];
  return area.sign();
}

template <class Number>
int area_sign(const CommonUnit& unit, std::span<const Vec3> corners, unsigned axis) {
  const unsigned i = (axis + 1) % 3, j = (axis + 2) % 3;
  const Point first(corners[0].x, corners[0].y, corners[0].z);
  std::array<Number, 3> u;
  Number area = 0;
  for (std::size_t k = 1; k < corners.size(); ++k) {
    auto v = unit.difference<Number>({corners[k].x, corners[k].y, corners[k].z}, first);
    if (k > 1) area += u[i] * v[j] - u[j] * v[i];
    u = std::move(v);
  }
  return area.sign();
}

}  // namespace

int exact_orientation(const Point& a, const Point& b, const Point& c, const Point& d) noexcept {
  const CommonUnit unit(std::array{&a, &b, &c, &d});
  return unit.small() ? orientation_sign<SmallWhole>(unit, a, b, c, d)
                      : orientation_sign<LargeWhole>(unit, a, b, c, d);
}

int exact_normal_sign(const Point& a, const Point& b, const Point& c, unsigned axis) noexcept {
  const CommonUnit unit(std::array{&a, &b, &c});
  return unit.small() ? area_sign<SmallWhole>(unit, a, b, c, axis)
                      : area_sign<LargeWhole>(unit, a, b, c, axis);
}

int exact_polygon_area_sign(std::span<const Vec3> corners, unsigned axis) noexcept {
  if (corners.size() < 3) return 0;
  const CommonUnit unit(corners);
  return unit.small() ? area_sign<SmallWhole>(unit, corners, axis)
                      : area_sign<LargeWhole>(unit, corners, axis);
}

}  // namespace planetree::octree
