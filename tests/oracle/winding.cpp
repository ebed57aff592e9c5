#include "tests/oracle/winding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <limits>
#include <numbers>

#include "tests/oracle/random.h"
#include "tests/oracle/whole_number.h"

namespace planetree::oracle {
namespace {

template <class T>
using Triple = std::array<T, 3>;

template <class T>
Triple<T> from_to(const Vec3& from, const Vec3& to) {
  return {T(to.x) - T(from.x), T(to.y) - T(from.y), T(to.z) - T(from.z)};
}

// u . (v x w)
template <class T>
T volume(const Triple<T>& u, const Triple<T>& v, const Triple<T>& w) {
  return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
         u[2] * (v[0] * w[1] - v[1] * w[0]);
}

// Sum of the magnitudes of the terms of volume().
long double magnitude(const Triple<long double>& u, const Triple<long double>& v,
                      const Triple<long double>& w) {
  const auto a = [](long double value) { return std::fabs(value); };
  return a(u[0]) * (a(v[1] * w[2]) + a(v[2] * w[1])) + a(u[1]) * (a(v[2] * w[0]) + a(v[0] * w[2])) +
         a(u[2]) * (a(v[0] * w[1]) + a(v[1] * w[0]));
}

// A difference of two points. A direction is given as a point minus the origin.
struct Difference {
  Vec3 from, to;
};

// Sign of u . (v x w), without any error.
int volume_sign(const Difference& u, const Difference& v, const Difference& w) {
  const auto approximate = [](const Difference& d) { return from_to<long double>(d.from, d.to); };
  const auto a = approximate(u), b = approximate(v), c = approximate(w);
  const long double found = volume(a, b, c);
  // Each of the three differences and up to three further operations is rounded to 2^-64.
  const long double error = 16 * 0x1p-64L * magnitude(a, b, c);
  if (std::fabs(found) > error && std::isfinite(error) && error > 0x1p-16000L)
    return found > 0 ? 1 : -1;
  int exponent = std::numeric_limits<int>::max();
  for (const Difference* d : {&u, &v, &w})
    exponent = std::min({exponent, last_exponent(d->from), last_exponent(d->to)});
  const auto exact = [exponent](const Difference& d) {
    const auto along = [exponent](double from, double to) {
      return Integer(to_integer(to, exponent) - to_integer(from, exponent));
    };
    return Triple<Integer>{along(d.from.x, d.to.x), along(d.from.y, d.to.y),
                           along(d.from.z, d.to.z)};
  };
  return volume<Integer>(exact(u), exact(v), exact(w)).sign();
}

enum class Pass { kMisses, kBackwards, kForwards, kOnIt, kUnclear };

// How the ray from `query` along `direction` passes a triangle.
Pass pass(const Vec3& query, const Vec3& direction, const Corners& t) {
  const Difference ray{{0, 0, 0}, direction};
  const Difference to[3] = {{query, t[0]}, {query, t[1]}, {query, t[2]}};
  const int sides[3] = {volume_sign(ray, to[0], to[1]), volume_sign(ray, to[1], to[2]),
                        volume_sign(ray, to[2], to[0])};
  const auto any = [&](int sign) {
    return sides[0] == sign || sides[1] == sign || sides[2] == sign;
  };
  if (any(1) && any(-1)) return Pass::kMisses;
  if (any(0)) {
    if (exact_square(query, t).numerator == 0) return Pass::kOnIt;
    const Difference edges[2] = {{t[0], t[1]}, {t[0], t[2]}};
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
      if (volume_sign({{0, 0, 0}, axis}, edges[0], edges[1]) != 0) return Pass::kUnclear;
    return Pass::kMisses;  // the triangle has no area
  }
  const int height = volume_sign(to[0], to[1], to[2]);
  if (height == 0) return Pass::kOnIt;
  if (height != sides[0]) return Pass::kMisses;  // the triangle lies behind the query
  return height > 0 ? Pass::kForwards : Pass::kBackwards;
}

// Unit vectors from the query to the corners; false if a corner equals the query.
template <class T>
bool directions(const Vec3& query, const Corners& t, std::array<Triple<T>, 3>& found) {
  using std::sqrt;
  for (std::size_t k = 0; k < 3; ++k) {
    found[k] = from_to<T>(query, t[k]);
    const T length =
        sqrt(T(found[k][0] * found[k][0] + found[k][1] * found[k][1] + found[k][2] * found[k][2]));
    if (length == 0) return false;
    for (T& component : found[k]) component /= length;
  }
  return true;
}

template <class T>
T scalar(const Triple<T>& u, const Triple<T>& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

// 1 + a . b + b . c + c . a of three unit vectors. Together with their volume it gives the tangent
// of half the solid angle.
template <class T>
T width_of(const std::array<Triple<T>, 3>& d) {
  return 1 + scalar(d[0], d[1]) + scalar(d[1], d[2]) + scalar(d[2], d[0]);
}

// Enough bits for a point that misses an edge by the smallest double.
using Widest = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<4608, boost::multiprecision::digit_base_2>,
    boost::multiprecision::et_off>;

// Half a solid angle of known sign; false if T has too few bits.
template <class T>
bool half_angle(const Vec3& query, const Corners& t, int sign, long double& found) {
  std::array<Triple<T>, 3> d;
  directions(query, t, d);
  const T width = width_of(d);
  const T height = abs(volume(d[0], d[1], d[2]));
  const T larger = std::max(T(abs(width)), height);
  if (larger < ldexp(T(1), 100 - std::numeric_limits<T>::digits)) return false;
  found = sign * std::atan2(static_cast<long double>(height / larger),
                            static_cast<long double>(width / larger));
  return true;
}

long double exact_half_angle(const Vec3& query, const Corners& t, int sign) {
  long double found = 0;
  if (!half_angle<Wide>(query, t, sign, found) && !half_angle<Widest>(query, t, sign, found))
    std::abort();
  return found;
}

}  // namespace

OpenWinding open_winding(const Vec3& query, std::span<const Corners> triangles) {
  OpenWinding winding;
  long double sum = 0;
  for (const Corners& t : triangles) {
    std::array<Triple<long double>, 3> d;
    if (directions(query, t, d)) {
      const long double width = width_of(d), height = volume(d[0], d[1], d[2]);
      // The angle of a triangle far aside is small, and so is its error.
      if (width > 1e-3L || (std::fabs(height) > 1e-17L && std::hypot(width, height) > 1e-3L)) {
        sum += std::atan2(height, width);
        continue;
      }
    }
    const int sign = volume_sign({query, t[0]}, {query, t[1]}, {query, t[2]});
    if (sign != 0)
      sum += exact_half_angle(query, t, sign);
    else
      winding.on_surface = winding.on_surface || exact_square(query, t).numerator == 0;
  }
  winding.value = sum / (2 * std::numbers::pi_v<long double>);
  return winding;
}

double quick_winding(const Vec3& query, std::span<const Corners> triangles) {
  // Half the solid angles are arguments of complex numbers. Their sum is the argument of the
  // product, plus the full turns that the product has made.
  std::complex<double> product = 1;
  int turns = 0;
  for (const Corners& t : triangles) {
    const auto a = from_to<double>(query, t[0]), b = from_to<double>(query, t[1]),
               c = from_to<double>(query, t[2]);
    const double la = std::sqrt(scalar(a, a)), lb = std::sqrt(scalar(b, b)),
                 lc = std::sqrt(scalar(c, c));
    const double height = volume(a, b, c);
    const double width = la * lb * lc + scalar(a, b) * lc + scalar(b, c) * la + scalar(c, a) * lb;
    const std::complex<double> next(product.real() * width - product.imag() * height,
                                    product.real() * height + product.imag() * width);
    if (product.imag() >= 0 && height >= 0 && next.imag() < 0) ++turns;
    if (product.imag() < 0 && height < 0 && next.imag() >= 0) --turns;
    product = next / (std::fabs(next.real()) + std::fabs(next.imag()));
  }
  return std::arg(product) / (2 * std::numbers::pi) + turns;
}

long double solid_angle_winding(const Vec3& query, std::span<const Corners> triangles) {
  long double sum = 0;
  for (const Corners& t : triangles) {
    const auto a = from_to<long double>(query, t[0]), b = from_to<long double>(query, t[1]),
               c = from_to<long double>(query, t[2]);
    const auto dot = [](const auto& u, const auto& v) {
      return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    };
    const long double la = std::sqrt(dot(a, a)), lb = std::sqrt(dot(b, b)),
                      lc = std::sqrt(dot(c, c));
    sum += 2 * std::atan2(volume(a, b, c),
                          la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (4 * std::numbers::pi_v<long double>);
}

Side exact_side(const Vec3& query, std::span<const Corners> triangles) {
  Random random(20240607);
  for (;;) {
    // Few bits, so that the integers stay short.
    const auto step = [&] { return static_cast<double>(random.below(2001)) - 1000.0; };
    const Vec3 direction{step(), step(), step()};
    std::int64_t winding = 0;
    bool clear = true;
    for (const Corners& triangle : triangles) {
      const Pass passed = pass(query, direction, triangle);
      if (passed == Pass::kOnIt) return Side::kOnSurface;
      clear = clear && passed != Pass::kUnclear;
      if (!clear) break;
      winding += passed == Pass::kForwards ? 1 : passed == Pass::kBackwards ? -1 : 0;
    }
    // A point on a later triangle would have been found with any direction.
    if (clear) return winding != 0 ? Side::kInside : Side::kOutside;
  }
}

}  // namespace planetree::oracle
