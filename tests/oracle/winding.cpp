#include "tests/oracle/winding.h"

#include <array>
#include <cmath>
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

// u . (v x w), and in `size` the sum of the magnitudes of its terms.
template <class T>
T volume(const Triple<T>& u, const Triple<T>& v, const Triple<T>& w) {
  return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
         u[2] * (v[0] * w[1] - v[1] * w[0]);
}

long double magnitude(const Triple<long double>& u, const Triple<long double>& v,
                      const Triple<long double>& w) {
  const auto a = [](long double value) { return std::fabs(value); };
  return a(u[0]) * (a(v[1] * w[2]) + a(v[2] * w[1])) + a(u[1]) * (a(v[2] * w[0]) + a(v[0] * w[2])) +
         a(u[2]) * (a(v[0] * w[1]) + a(v[1] * w[0]));
}

// The sign of p . (q x r) of three differences of points, without any error.
// `origin` is where they start; a direction is given as a point from 0.
struct Difference {
  Vec3 from, to;
};

int volume_sign(const Difference& u, const Difference& v, const Difference& w) {
  const auto approximate = [](const Difference& d) { return from_to<long double>(d.from, d.to); };
  const auto a = approximate(u), b = approximate(v), c = approximate(w);
  const long double found = volume(a, b, c);
  // Three differences and three operations deep, each rounded to 2^-64.
  const long double error = 16 * 0x1p-64L * magnitude(a, b, c);
  if (std::fabs(found) > error && std::isfinite(error) && error > 0x1p-16000L)
    return found > 0 ? 1 : -1;
  int exponent = std::numeric_limits<int>::max();
  for (const Difference* d : {&u, &v, &w})
    exponent = std::min({exponent, last_exponent(d->from), last_exponent(d->to)});
  const auto exact = [exponent](const Difference& d) {
    const auto along = [exponent](double from, double to) {
      return Integer(whole(to, exponent) - whole(from, exponent));
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
    return Pass::kMisses;  // it has no area
  }
  const int height = volume_sign(to[0], to[1], to[2]);
  if (height == 0) return Pass::kOnIt;
  if (height != sides[0]) return Pass::kMisses;  // it lies behind
  return height > 0 ? Pass::kForwards : Pass::kBackwards;
}

}  // namespace

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
    // Few bits, so that rationals stay short.
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
