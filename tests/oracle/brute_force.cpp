#include "tests/oracle/brute_force.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "tests/oracle/whole_number.h"

namespace planetree::oracle {
namespace {

template <class Scalar>
struct Vector {
  Scalar x, y, z;
};

template <class Scalar>
Vector<Scalar> operator-(const Vector<Scalar>& a, const Vector<Scalar>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class Scalar>
Scalar dot(const Vector<Scalar>& a, const Vector<Scalar>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Scalar>
Vector<Scalar> cross(const Vector<Scalar>& a, const Vector<Scalar>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// A squared distance as a fraction.
template <class Scalar>
struct Fraction {
  Scalar numerator, denominator;
};

template <class Scalar>
Fraction<Scalar> to_segment(const Vector<Scalar>& p, const Vector<Scalar>& a,
                            const Vector<Scalar>& b) {
  const auto ab = b - a, ap = p - a, bp = p - b;
  const Scalar along = dot(ap, ab);
  if (along <= 0) return {dot(ap, ap), Scalar(1)};
  if (dot(bp, ab) >= 0) return {dot(bp, bp), Scalar(1)};
  const auto aside = cross(ap, ab);
  return {dot(aside, aside), dot(ab, ab)};
}

template <class Scalar>
bool less(const Fraction<Scalar>& left, const Fraction<Scalar>& right) {
  return left.numerator * right.denominator < right.numerator * left.denominator;
}

template <class Scalar>
Fraction<Scalar> to_edges(const Vector<Scalar>& p, const std::array<Vector<Scalar>, 3>& corner) {
  auto best = to_segment(p, corner[0], corner[1]);
  for (std::size_t k = 1; k < 3; ++k) {
    const auto other = to_segment(p, corner[k], corner[(k + 1) % 3]);
    if (less(other, best)) best = other;
  }
  return best;
}

// The signs of the region tests are right if Scalar is exact.
template <class Scalar>
Fraction<Scalar> to_triangle(const Vector<Scalar>& p, const std::array<Vector<Scalar>, 3>& corner) {
  const auto& [a, b, c] = corner;
  const auto ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const auto normal = cross(ab, ac);
  const Scalar normal2 = dot(normal, normal);
  if (normal2 == 0) return to_edges(p, corner);
  const Scalar d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {dot(ap, ap), Scalar(1)};
  const Scalar d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {dot(bp, bp), Scalar(1)};
  const Scalar vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return to_segment(p, a, b);
  const Scalar d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {dot(cp, cp), Scalar(1)};
  const Scalar vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return to_segment(p, a, c);
  const Scalar va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return to_segment(p, b, c);
  const Scalar height = dot(normal, ap);
  return {height * height, normal2};
}

Vector<long double> extended(const Vec3& p) { return {p.x, p.y, p.z}; }

Vector<Integer> to_integer(const Vec3& p, int exponent) {
  return {oracle::to_integer(p.x, exponent), oracle::to_integer(p.y, exponent),
          oracle::to_integer(p.z, exponent)};
}

Wide power_of_two(int exponent) { return ldexp(Wide(1), exponent); }

// Bounds on a triangle's distance that hold in spite of rounding: from below by its box, from above
// by its nearest corner.
struct RoughBounds {
  long double lower, upper;
};

RoughBounds rough_bounds(const Vec3& query, const Corners& triangle) {
  const auto p = extended(query);
  Vector<long double> low = extended(triangle[0]), high = low;
  long double nearest = std::numeric_limits<long double>::infinity();
  for (const Vec3& at : triangle) {
    const auto corner = extended(at);
    low = {std::min(low.x, corner.x), std::min(low.y, corner.y), std::min(low.z, corner.z)};
    high = {std::max(high.x, corner.x), std::max(high.y, corner.y), std::max(high.z, corner.z)};
    const auto gap = corner - p;
    nearest = std::min(nearest, std::sqrt(dot(gap, gap)));
  }
  const auto outside = [](long double from, long double to, long double value) {
    return std::max({from - value, value - to, 0.0L});
  };
  const Vector<long double> gap{outside(low.x, high.x, p.x), outside(low.y, high.y, p.y),
                                outside(low.z, high.z, p.z)};
  constexpr long double kRoundingMargin = 0x1p-50L;
  return {std::sqrt(dot(gap, gap)) * (1 - kRoundingMargin), nearest * (1 + kRoundingMargin)};
}

}  // namespace

long double extended_distance(const Vec3& query, const Corners& triangle) {
  const auto fraction = to_triangle<long double>(
      extended(query), {extended(triangle[0]), extended(triangle[1]), extended(triangle[2])});
  return std::sqrt(fraction.numerator / fraction.denominator);
}

long double extended_distance(const Vec3& query, std::span<const Corners> triangles) {
  long double best = std::numeric_limits<long double>::infinity();
  for (const Corners& triangle : triangles)
    best = std::min(best, extended_distance(query, triangle));
  return best;
}

Wide ExactSquare::root() const {
  return sqrt(Wide(numerator) / Wide(denominator)) * power_of_two(exponent);
}

ExactSquare exact_square(const Vec3& query, const Corners& triangle) {
  int exponent = std::min({last_exponent(query), last_exponent(triangle[0]),
                           last_exponent(triangle[1]), last_exponent(triangle[2])});
  if (exponent == std::numeric_limits<int>::max()) exponent = 0;
  auto fraction =
      to_triangle<Integer>(to_integer(query, exponent),
                           {to_integer(triangle[0], exponent), to_integer(triangle[1], exponent),
                            to_integer(triangle[2], exponent)});
  return {std::move(fraction.numerator), std::move(fraction.denominator), exponent};
}

Wide exact_distance(const Vec3& query, std::span<const Corners> triangles) {
  std::vector<RoughBounds> bounds;
  long double reach = std::numeric_limits<long double>::infinity();
  for (const Corners& triangle : triangles) {
    bounds.push_back(rough_bounds(query, triangle));
    reach = std::min(reach, bounds.back().upper);
  }
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (bounds[i].lower <= reach) order.push_back(i);
  std::ranges::sort(order, {}, [&](std::size_t i) { return bounds[i].lower; });
  Wide best = -1;
  for (const std::size_t i : order) {
    if (best >= 0 && Wide(bounds[i].lower) > best) break;
    const Wide distance = exact_square(query, triangles[i]).root();
    if (best < 0 || distance < best) best = distance;
  }
  return best;
}

}  // namespace planetree::oracle
