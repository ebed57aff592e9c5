#include "tests/golden/spec_signs.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>

#include "tests/golden/spec_vector.h"

namespace planetree::golden {
namespace {

using Whole = boost::multiprecision::cpp_int;
using Exact = std::array<Whole, 3>;

/// More than f64 rounds in a product of three differences.
constexpr double kRounding = 1e-11;

Exact exact(const SpecPoint& point) {
  Exact found;
  for (std::size_t axis = 0; axis < 3; ++axis) found[axis] = Whole(std::ldexp(point[axis], 200));
  return found;
}

Exact difference(const SpecPoint& a, const SpecPoint& b) {
  const Exact from = exact(b);
  Exact found = exact(a);
  for (std::size_t axis = 0; axis < 3; ++axis) found[axis] -= from[axis];
  return found;
}

Exact product(const Exact& a, const Exact& b) {
  return {Whole(a[1] * b[2] - a[2] * b[1]), Whole(a[2] * b[0] - a[0] * b[2]),
          Whole(a[0] * b[1] - a[1] * b[0])};
}

Whole inner(const Exact& a, const Exact& b) {
  return Whole(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

int sign(double value) { return value < 0 ? -1 : value > 0 ? 1 : 0; }

int first_sign(const Whole& value, const Exact& others) {
  if (value != 0) return value.sign();
  for (const Whole& other : others)
    if (other != 0) return other.sign();
  return 0;
}

int side_of_edge(const SpecPoint& p, const SpecPoint& q, const SpecPoint& u, const SpecPoint& v) {
  const double rounded = dot(q - p, cross(u - p, v - p));
  if (std::fabs(rounded) > kRounding) return sign(rounded);
  const Exact way = difference(q, p);
  return first_sign(inner(way, product(difference(u, p), difference(v, p))),
                    product(way, difference(v, u)));
}

}  // namespace

int side_of_plane(const SpecPoint& x, const SpecCorners& t) {
  const double rounded = dot(cross(t[1] - t[0], t[2] - t[0]), x - t[0]);
  if (std::fabs(rounded) > kRounding) return sign(rounded);
  const Exact n = product(difference(t[1], t[0]), difference(t[2], t[0]));
  return first_sign(inner(n, difference(x, t[0])), n);
}

int crossing(const SpecPoint& p, const SpecPoint& q, const SpecCorners& t) {
  const int at_p = side_of_plane(p, t), at_q = side_of_plane(q, t);
  if (at_p == 0 || at_p == at_q) return 0;
  const int e = side_of_edge(p, q, t[0], t[1]);
  if (side_of_edge(p, q, t[1], t[2]) != e || side_of_edge(p, q, t[2], t[0]) != e) return 0;
  return at_p == -1 ? 1 : -1;
}

bool is_on_edge(const SpecPoint& p, const SpecPoint& u, const SpecPoint& v) {
  const SpecPoint rounded = cross(v - u, p - u);
  if (length(rounded) > kRounding) return false;
  const Exact off = product(difference(v, u), difference(p, u));
  return inner(off, off) == 0 && inner(difference(p, u), difference(p, v)) <= 0;
}

bool is_on(const SpecPoint& p, const SpecCorners& t) {
  if (std::fabs(dot(cross(t[1] - t[0], t[2] - t[0]), p - t[0])) > kRounding) return false;
  const Exact n = product(difference(t[1], t[0]), difference(t[2], t[0]));
  if (inner(n, n) == 0)
    return is_on_edge(p, t[0], t[1]) || is_on_edge(p, t[1], t[2]) || is_on_edge(p, t[2], t[0]);
  bool inside = inner(n, difference(p, t[0])) == 0;
  for (std::size_t i = 0; i < 3; ++i)
    inside =
        inside && inner(n, product(difference(t[(i + 1) % 3], t[i]), difference(p, t[i]))) >= 0;
  return inside;
}

}  // namespace planetree::golden
