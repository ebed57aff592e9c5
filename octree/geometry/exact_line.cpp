#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/exact_numbers.h"
#include "octree/geometry/line_crossing.h"

namespace planetree::octree {
namespace {

template <class Number>
int turn_sign(const std::array<Number, 3>& u, const std::array<Number, 3>& v, unsigned axis) {
  const unsigned i = (axis + 1) % 3, j = (axis + 2) % 3;
  const Number left = u[i] * v[j], right = u[j] * v[i];
  return left > right ? 1 : left < right ? -1 : 0;
}

// The leading bits of a number that is not 0: value = mantissa * 2^exponent within 2^-63.
struct Leading {
  double mantissa;
  int exponent;
};
Leading leading(Int128 value) { return {static_cast<double>(value), 0}; }
template <unsigned kBits>
Leading leading(const Whole<kBits>& value) {
  constexpr unsigned kKept = 63;
  const Whole<kBits> magnitude = value < 0 ? Whole<kBits>(-value) : value;
  const unsigned top = msb(magnitude);
  const unsigned shift = top > kKept ? top - kKept : 0;
  const auto kept = static_cast<std::uint64_t>(magnitude >> shift);
  const double mantissa = static_cast<double>(kept);
  return {value < 0 ? -mantissa : mantissa, static_cast<int>(shift)};
}

// The rounded quotient is on the same side of 0 and of 1, the ends of a segment, as the true one.
template <class Number>
double ratio(const Number& numerator, const Number& denominator) {
  if (numerator == 0 || denominator == 0) return 0;
  if (numerator == denominator) return 1;
  const Leading above = leading(numerator), below = leading(denominator);
  const double quotient = above.mantissa / below.mantissa;
  const double rounded = std::ldexp(quotient, above.exponent - below.exponent);
  if (std::fabs(rounded) < kMinPosition) return std::copysign(kMinPosition, quotient);
  const bool is_less = denominator > 0 ? numerator < denominator : numerator > denominator;
  return is_less ? std::min(rounded, std::nextafter(1.0, 0.0))
                 : std::max(rounded, std::nextafter(1.0, 2.0));
}

template <class Number, class Unit>
double position(const Unit& unit, const Line& line, const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  const auto difference = [&](const Point& to, const Point& from) {
    if constexpr (std::is_same_v<Unit, AxisUnits>)
      return unit.difference(to, from);
    else
      return unit.template difference<Number>(to, from);
  };
  const auto u = difference(b, a), v = difference(c, a);
  return ratio(determinant(u, v, difference(a, line.origin)),
               determinant(u, v, difference(line.head, line.tail)));
}

template <class Number>
int line_side(const CommonUnit& unit, const Line& line, const Point& a, const Point& b) {
  return determinant(unit.difference<Number>(line.origin, b),
                     unit.difference<Number>(line.head, line.tail), unit.difference<Number>(a, b))
      .sign();
}

template <class Number>
int turn_sign(const CommonUnit& unit, const Line& line, const Point& a, const Point& b,
              unsigned axis) {
  return turn_sign(unit.difference<Number>(line.head, line.tail), unit.difference<Number>(a, b),
                   axis);
}

}  // namespace

int exact_line_side(const Line& line, const Point& a, const Point& b, WorkLimit* limit) noexcept {
  const std::array points{&line.origin, &line.head, &line.tail, &a, &b};
  if (const AxisUnits units(points); units.small()) {
    if (!may_take(limit, WorkUnits::kSmallSign)) return 0;
    return sign_of(determinant(units.difference(line.origin, b),
                               units.difference(line.head, line.tail), units.difference(a, b)));
  }
  const CommonUnit unit(points);
  if (!may_take(limit, units_of(unit))) return 0;
  return unit.small() ? line_side<SmallWhole>(unit, line, a, b)
                      : line_side<LargeWhole>(unit, line, a, b);
}

int exact_turn_sign(const Line& line, const Point& a, const Point& b, unsigned axis,
                    WorkLimit* limit) noexcept {
  const std::array points{&line.head, &line.tail, &a, &b};
  if (const AxisUnits units(points); units.small()) {
    if (!may_take(limit, WorkUnits::kSmallSign)) return 0;
    return turn_sign(units.difference(line.head, line.tail), units.difference(a, b), axis);
  }
  const CommonUnit unit(points);
  if (!may_take(limit, units_of(unit))) return 0;
  return unit.small() ? turn_sign<SmallWhole>(unit, line, a, b, axis)
                      : turn_sign<LargeWhole>(unit, line, a, b, axis);
}

double exact_position(const Line& line, const Triangle& triangle, WorkLimit* limit) noexcept {
  const std::array points{&line.origin, &line.head,   &line.tail,
                          &triangle[0], &triangle[1], &triangle[2]};
  if (const AxisUnits units(points); units.small()) {
    if (!may_take(limit, 2 * WorkUnits::kSmallSign)) return 0;
    return position<Int128>(units, line, triangle);
  }
  const CommonUnit unit(points);
  if (!may_take(limit, 2 * units_of(unit))) return 0;
  return unit.small() ? position<SmallWhole>(unit, line, triangle)
                      : position<LargeWhole>(unit, line, triangle);
}

}  // namespace planetree::octree
