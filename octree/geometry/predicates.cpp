#include "octree/geometry/predicates.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

/// Bound on what flushing subnormal differences and products to zero may change, if no difference
/// exceeds `largest`.
double flush_loss(double largest) { return kFlushLoss * (1 + largest) * (1 + largest); }

int sign_of(double value) { return value > 0 ? 1 : -1; }

/// Compares bits because == may treat subnormal numbers as zero, depending on the thread's mode.
bool same_bits(const Point& a, const Point& b) {
  return std::memcmp(a.data(), b.data(), 3 * sizeof(double)) == 0;
}
bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// Returns whether the points lie in one plane perpendicular to an axis, as on faces of boxes.
bool in_axis_plane(const Point& a, const Point& b, const Point& c, const Point& d) {
  for (unsigned axis = 0; axis < 3; ++axis)
    if (same_bits(a[axis], b[axis]) && same_bits(a[axis], c[axis]) && same_bits(a[axis], d[axis]))
      return true;
  return false;
}

}  // namespace

int orientation(const Point& a, const Point& b, const Point& c, const Point& d,
                WorkLimit* limit) noexcept {
  const Point u = b - a, v = c - a, w = d - a;
  const double xy = v.x() * w.y(), yx = v.y() * w.x();
  const double yz = v.y() * w.z(), zy = v.z() * w.y();
  const double zx = v.z() * w.x(), xz = v.x() * w.z();
  const double volume = u.x() * (yz - zy) + u.y() * (zx - xz) + u.z() * (xy - yx);
  const double permanent = std::fabs(u.x()) * (std::fabs(yz) + std::fabs(zy)) +
                           std::fabs(u.y()) * (std::fabs(zx) + std::fabs(xz)) +
                           std::fabs(u.z()) * (std::fabs(xy) + std::fabs(yx));
  const double largest =
      std::max({u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff(), w.cwiseAbs().maxCoeff()});
  if (std::fabs(volume) > kOrientationFilter * permanent + flush_loss(largest))
    return sign_of(volume);
  // The most frequent remaining case: d is a corner of the triangle.
  if (same_bits(d, a) || same_bits(d, b) || same_bits(d, c)) return 0;
  if (in_axis_plane(a, b, c, d)) return 0;
  return exact_orientation(a, b, c, d, limit);
}

int normal_sign(const Point& a, const Point& b, const Point& c, unsigned axis,
                WorkLimit* limit) noexcept {
  const unsigned i = (axis + 1) % 3, j = (axis + 2) % 3;
  const double left = (b[i] - a[i]) * (c[j] - a[j]);
  const double right = (b[j] - a[j]) * (c[i] - a[i]);
  const double area = left - right;
  const double largest = std::max((b - a).cwiseAbs().maxCoeff(), (c - a).cwiseAbs().maxCoeff());
  if (std::fabs(area) >
      kNormalSignFilter * (std::fabs(left) + std::fabs(right)) + flush_loss(largest))
    return sign_of(area);
  if ((same_bits(b[i], a[i]) || same_bits(c[j], a[j])) &&
      (same_bits(b[j], a[j]) || same_bits(c[i], a[i])))
    return 0;
  return exact_normal_sign(a, b, c, axis, limit);
}

// The sum of the fan about corner 0. Each term errs by a share of its permanent, and the sum by one
// rounding of at most the sum of the permanents for each term.
int polygon_area_sign(std::span<const Vec3> corners, unsigned axis) noexcept {
  const auto at = [&corners](std::size_t k) {
    return Point(corners[k].x, corners[k].y, corners[k].z);
  };
  const unsigned i = (axis + 1) % 3, j = (axis + 2) % 3;
  double area = 0, permanent = 0, largest = 0;
  for (std::size_t k = 2; k < corners.size(); ++k) {
    const Point u = at(k - 1) - at(0), v = at(k) - at(0);
    const double left = u[i] * v[j], right = u[j] * v[i];
    area += left - right;
    permanent += std::fabs(left) + std::fabs(right);
    largest = std::max({largest, u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff()});
  }
  const auto count = static_cast<double>(corners.size());
  if (std::fabs(area) >
      (kNormalSignFilter + kAreaSumFilter * count) * permanent + count * flush_loss(largest))
    return sign_of(area);
  return exact_polygon_area_sign(corners, axis);
}

// The point's step is (s1, s2, s3) with s1 >> s2 >> s3 > 0.
int perturbed_side(const Triangle& triangle, const Point& point, WorkLimit* limit) noexcept {
  const auto& [a, b, c] = triangle;
  int side = orientation(a, b, c, point, limit);
  for (unsigned axis = 0; side == 0 && axis < 3; ++axis) side = normal_sign(a, b, c, axis, limit);
  return side;
}

bool lies_on(const Point& point, const Triangle& triangle, WorkLimit* limit) noexcept {
  const auto& [a, b, c] = triangle;
  if ((point.array() < least_corner(triangle).array()).any() ||
      (point.array() > greatest_corner(triangle).array()).any())
    return false;
  if (orientation(a, b, c, point, limit) != 0) return false;
  // A point in the triangle's plane lies on the triangle if, seen along each axis, it is not on
  // different sides of two edges. A triangle without area is the part of its line within its box.
  for (unsigned axis = 0; axis < 3; ++axis) {
    const int sides[] = {normal_sign(a, b, point, axis, limit),
                         normal_sign(b, c, point, axis, limit),
                         normal_sign(c, a, point, axis, limit)};
    const auto [least, greatest] = std::minmax_element(std::begin(sides), std::end(sides));
    if (*least < 0 && *greatest > 0) return false;
  }
  return true;
}

namespace {

int compare(double left, double right) { return left < right ? -1 : left > right ? 1 : 0; }

/// Returns the sign of det[p - b, q - b, a - b] for the perturbed ends p and q of the segment: the
/// side on which it passes the line through a and b. The first term that is not zero decides. In
/// order of decreasing magnitude, with e = a - b, the terms are
///
///     the determinant itself,
///     steps of p:  (q - b) x e,
///     steps of q:  e x (p - b),
///     products:    (step of q) . (e x step of p).
int passing_side(const PerturbedSegment& segment, const Point& a, const Point& b,
                 WorkLimit* limit) {
  int side = orientation(b, segment.from, segment.to, a, limit);
  for (unsigned axis = 0; side == 0 && axis < 3; ++axis)
    side = normal_sign(b, segment.to, a, axis, limit);
  if (side != 0) return side;
  const int e[3] = {compare(a.x(), b.x()), compare(a.y(), b.y()), compare(a.z(), b.z())};
  const int products[3][2] = {{-e[2], e[1]}, {e[2], -e[0]}, {-e[1], e[0]}};
  for (unsigned axis = 0; side == 0 && axis < 3; ++axis) {
    side = normal_sign(b, a, segment.from, axis, limit);
    for (const int product : products[axis])
      if (side == 0) side = product;
  }
  return side;
}

}  // namespace

int crossing(const PerturbedSegment& segment, const Triangle& triangle, WorkLimit* limit) noexcept {
  const int from = perturbed_side(triangle, segment.from, limit);
  if (from == 0 || from == perturbed_side(triangle, segment.to, limit)) return 0;
  const auto& [a, b, c] = triangle;
  const int passing = passing_side(segment, a, b, limit);
  if (passing != passing_side(segment, b, c, limit) ||
      passing != passing_side(segment, c, a, limit))
    return 0;
  return -from;
}

}  // namespace planetree::octree
