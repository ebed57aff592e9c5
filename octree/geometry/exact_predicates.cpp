#include "octree/geometry/predicates.h"

#include <array>
#include <cstddef>
#include <utility>

#include "octree/geometry/exact_numbers.h"

namespace planetree::octree {
namespace {

template <class Number>
int orientation_sign(const CommonUnit& unit, const Point& a, const Point& b, const Point& c,
                     const Point& d) {
  const auto u = unit.difference<Number>(b, a), v = unit.difference<Number>(c, a),
             w = unit.difference<Number>(d, a);
  return determinant(u, v, w).sign();
}

/// Returns a component of u x v.
template <class Number>
Number area(const std::array<Number, 3>& u, const std::array<Number, 3>& v, unsigned axis) {
  const unsigned i = (axis + 1) % 3, j = (axis + 2) % 3;
  return u[i] * v[j] - u[j] * v[i];
}

template <class Number>
int area_sign(const CommonUnit& unit, const Point& a, const Point& b, const Point& c,
              unsigned axis) {
  return area(unit.difference<Number>(b, a), unit.difference<Number>(c, a), axis).sign();
}

template <class Number>
int area_sign(const CommonUnit& unit, std::span<const Vec3> corners, unsigned axis) {
  const Point first(corners[0].x, corners[0].y, corners[0].z);
  std::array<Number, 3> u;
  Number sum = 0;
  for (std::size_t k = 1; k < corners.size(); ++k) {
    auto v = unit.difference<Number>({corners[k].x, corners[k].y, corners[k].z}, first);
    if (k > 1) sum += area(u, v, axis);
    u = std::move(v);
  }
  return sum.sign();
}

}  // namespace

int exact_orientation(const Point& a, const Point& b, const Point& c, const Point& d,
                      WorkLimit* limit) noexcept {
  if (const AxisUnits units(std::array{&a, &b, &c, &d}); units.small()) {
    if (!may_take(limit, WorkUnits::kSmallSign)) return 0;
    const auto u = units.difference(b, a), v = units.difference(c, a), w = units.difference(d, a);
    return sign_of(determinant(u, v, w));
  }
  const CommonUnit unit(std::array{&a, &b, &c, &d});
  if (!may_take(limit, units_of(unit))) return 0;
  return unit.small() ? orientation_sign<SmallWhole>(unit, a, b, c, d)
                      : orientation_sign<LargeWhole>(unit, a, b, c, d);
}

int exact_normal_sign(const Point& a, const Point& b, const Point& c, unsigned axis,
                      WorkLimit* limit) noexcept {
  if (const AxisUnits units(std::array{&a, &b, &c}); units.small()) {
    if (!may_take(limit, WorkUnits::kSmallSign)) return 0;
    return sign_of(area(units.difference(b, a), units.difference(c, a), axis));
  }
  const CommonUnit unit(std::array{&a, &b, &c});
  if (!may_take(limit, units_of(unit))) return 0;
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
