#include "tests/oracle/queries/way_oracle.h"

#include <algorithm>
#include <cmath>

namespace planetree::oracle {
namespace {

template <class Real>
using Vector = std::array<Real, 3>;

template <class Real>
Vector<Real> of(const Vec3& v) {
  return {Real(v.x), Real(v.y), Real(v.z)};
}
template <class Real>
Vector<Real> minus(const Vector<Real>& a, const Vector<Real>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class Real>
Vector<Real> along(const Vector<Real>& a, const Real& t, const Vector<Real>& way) {
  return {a[0] + t * way[0], a[1] + t * way[1], a[2] + t * way[2]};
}
template <class Real>
Real dot(const Vector<Real>& a, const Vector<Real>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Real>
Vector<Real> cross(const Vector<Real>& a, const Vector<Real>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class Real>
int sign_of(const Real& value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

template <class Real>
Real point_segment2(const Vector<Real>& p, const Vector<Real>& a, const Vector<Real>& b) {
  const Vector<Real> edge = minus(b, a), to = minus(p, a);
  const Real length2 = dot(edge, edge);
  Real share = length2 > 0 ? Real(dot(to, edge) / length2) : Real(0);
  share = share < 0 ? Real(0) : share > 1 ? Real(1) : share;
  const Vector<Real> gap = minus(p, along(a, share, edge));
  return dot(gap, gap);
}

template <class Real>
Real segments2(const Vector<Real>& p, const Vector<Real>& q, const Vector<Real>& a,
               const Vector<Real>& b) {
  Real least = std::min({point_segment2(p, a, b), point_segment2(q, a, b), point_segment2(a, p, q),
                         point_segment2(b, p, q)});
  const Vector<Real> u = minus(q, p), v = minus(b, a), w = minus(p, a);
  const Vector<Real> normal = cross(u, v);
  const Real normal2 = dot(normal, normal);
  if (!(normal2 > 0)) return least;
  const Real s = dot(cross(v, w), normal) / normal2, t = dot(cross(u, w), normal) / normal2;
  if (s >= 0 && s <= 1 && t >= 0 && t <= 1) {
    const Real height = dot(w, normal);
    least = std::min(least, Real(height * height / normal2));
  }
  return least;
}

// The squared distance of a point from a face, if it is above it; else `none`.
template <class Real>
Real above_face2(const Vector<Real>& p, const std::array<Vector<Real>, 3>& c, const Real& none) {
  const Vector<Real> normal = cross(minus(c[1], c[0]), minus(c[2], c[0]));
  const Real normal2 = dot(normal, normal);
  if (!(normal2 > 0)) return none;
  for (int k = 0; k < 3; ++k)
    if (dot(cross(minus(c[(k + 1) % 3], c[k]), minus(p, c[k])), normal) < 0) return none;
  const Real height = dot(minus(p, c[0]), normal);
  return height * height / normal2;
}

template <class Real>
Real way_distance(const Sweep& sweep, double t, const Corners& triangle) {
  const Vector<Real> p = of<Real>(sweep.from);
  const Vector<Real> q = along(p, Real(t), minus(of<Real>(sweep.to), p));
  const std::array<Vector<Real>, 3> c{of<Real>(triangle[0]), of<Real>(triangle[1]),
                                      of<Real>(triangle[2])};
  Real least = segments2(p, q, c[0], c[1]);
  least = std::min(least, segments2(p, q, c[1], c[2]));
  least = std::min(least, segments2(p, q, c[2], c[0]));
  least = above_face2(p, c, least) < least ? above_face2(p, c, least) : least;
  least = above_face2(q, c, least) < least ? above_face2(q, c, least) : least;
  // The way passes through the face.
  const Vector<Real> normal = cross(minus(c[1], c[0]), minus(c[2], c[0]));
  const Real begin = dot(minus(p, c[0]), normal), end = dot(minus(q, c[0]), normal);
  if (sign_of(begin) * sign_of(end) < 0) {
    const Vector<Real> at = along(p, Real(begin / (begin - end)), minus(q, p));
    const Real on = above_face2(at, c, Real(-1));
    if (on >= 0) least = 0;
  }
  using std::sqrt;
  return sqrt(least);
}

// Whether long double shows that a line passes a triangle on different sides of its edges. A triple
// product of differences errs by less than 64 roundings of its factors.
bool clearly_misses(const Vec3& origin, const std::array<Rational, 3>& direction,
                    const Corners& triangle) {
  using Real = long double;
  const Vector<Real> o = of<Real>(origin);
  const Vector<Real> d{static_cast<Real>(direction[0]), static_cast<Real>(direction[1]),
                       static_cast<Real>(direction[2])};
  const auto largest = [](const Vector<Real>& v) {
    return std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
  };
  bool positive = false, negative = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector<Real> a = minus(of<Real>(triangle[k]), o);
    const Vector<Real> b = minus(of<Real>(triangle[(k + 1) % 3]), o);
    const Real error = 1e-16L * largest(d) * largest(a) * largest(b);
    const Real side = dot(d, cross(a, b));
    positive = positive || side > error;
    negative = negative || side < -error;
  }
  return positive && negative;
}

double extent(const Sweep& sweep, const Corners& triangle) {
  double largest = sweep.radius;
  for (const Vec3& v : {sweep.from, sweep.to, triangle[0], triangle[1], triangle[2]})
    largest = std::max({largest, std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  return largest;
}

}  // namespace

std::array<Rational, 3> exact_difference(const Vec3& to, const Vec3& from) {
  return minus(of<Rational>(to), of<Rational>(from));
}

LineMeeting meet(const Vec3& origin, const std::array<Rational, 3>& direction,
                 const Corners& triangle) {
  if (clearly_misses(origin, direction, triangle)) return {};
  const Vector<Rational> o = of<Rational>(origin);
  const std::array<Vector<Rational>, 3> c{of<Rational>(triangle[0]), of<Rational>(triangle[1]),
                                          of<Rational>(triangle[2])};
  const Vector<Rational> normal = cross(minus(c[1], c[0]), minus(c[2], c[0]));
  const Rational slope = dot(normal, direction);
  int least = 1, greatest = -1;
  for (int k = 0; k < 3; ++k) {
    const int side = sign_of(dot(direction, cross(minus(c[k], o), minus(c[(k + 1) % 3], o))));
    least = std::min(least, side);
    greatest = std::max(greatest, side);
  }
  LineMeeting found;
  if (least < 0 && greatest > 0) return found;
  found.meeting = least * greatest > 0 && slope != 0 ? Meeting::kPasses : Meeting::kTouches;
  if (slope != 0) {
    found.has_t = true;
    found.t = dot(normal, minus(c[0], o)) / slope;
    found.entering = slope < 0;
  }
  return found;
}

int compare_way(const Sweep& sweep, double t, const Corners& triangle) {
  const double size = extent(sweep, triangle);
  const long double rough = way_distance<long double>(sweep, t, triangle);
  // Needles cost long double half of its digits.
  if (std::fabs(rough - sweep.radius) > 1e-9L * size) return rough > sweep.radius ? 1 : -1;
  const Quad difference = way_distance<Quad>(sweep, t, triangle) - Quad(sweep.radius);
  return abs(difference) < Quad(1e-27) * size ? 0 : sign_of(difference);
}

}  // namespace planetree::oracle
