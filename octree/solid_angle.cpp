#include "octree/solid_angle.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "octree/angle.h"
#include "octree/predicates.h"
#include "octree/strict_math.h"
#include "octree/wide_float.h"

namespace planetree::octree {
namespace {

constexpr double kOverTwoPi = 0x1.45f306dc9c883p-3;  ///< 1 / (2 pi)

/// With a, b, c the directions of the corners, tan(omega / 2) = height / width:
/// height = a . (b x c), width = 1 + a . b + b . c + c . a. Half the solid
/// angle is the angle of that vector, so that its end being off by `error`
/// turns it by no more than asin(error / true length).
struct HalfAngle {
  double width = 0;
  double height = 0;
  double error = 0;   ///< the true vector ends at most so far from (width, height)
  double length = 0;  ///< of (width, height)

  bool tells_angle() const { return error < 0x1p-24 * length; }
};

/// Directions in double are right to 8 roundings a component: one of the
/// difference, one of the first quotient, five of the length, one of the last
/// quotient. Each of three products of components loses 17 more, so that width
/// errs by 72 roundings and height, whose six terms have magnitudes that sum to
/// at most 1.16, by 35: their end by 80. 256 covers that also where every
/// rounding is of a whole ulp.
constexpr double kDoubleError = 256 * 0x1p-53;

/// Shorter differences may lose bits to underflow.
constexpr double kShort = 0x1p-900;

bool make_direction(Point& way) {
  const double largest = way.cwiseAbs().maxCoeff();
  if (!(largest > kShort)) return false;
  way /= largest;
  way /= way.norm();
  return true;
}

constexpr HalfAngle kUntold{0, 0, 1, 0};

HalfAngle in_double(const Point& point, const Triangle& triangle) {
  Point a = triangle[0] - point, b = triangle[1] - point, c = triangle[2] - point;
  if (!make_direction(a) || !make_direction(b) || !make_direction(c)) return kUntold;
  HalfAngle half;
  half.width = 1 + a.dot(b) + b.dot(c) + c.dot(a);
  half.height = a.dot(b.cross(c));
  half.error = kDoubleError;
  half.length = std::sqrt(half.width * half.width + half.height * half.height);
  return half;
}

template <class Scalar>
Vector3<Scalar> wide_direction(const Point& from, const Point& to) {
  Vector3<Scalar> way;
  for (unsigned axis = 0; axis < 3; ++axis)
    way[axis] = wide<Scalar>(to[axis]) - wide<Scalar>(from[axis]);
  const Scalar length = sqrt(dot(way, way));
  for (Scalar& component : way) component /= length;
  return way;
}

/// The same in wider numbers. No corner is where the point is. What is returned
/// is scaled to a length of about 1.
template <class Scalar>
HalfAngle in_wide(const Point& point, const Triangle& triangle) {
  const auto a = wide_direction<Scalar>(point, triangle[0]);
  const auto b = wide_direction<Scalar>(point, triangle[1]);
  const auto c = wide_direction<Scalar>(point, triangle[2]);
  const Scalar width = 1 + dot(a, b) + dot(b, c) + dot(c, a);
  const Scalar height = dot(a, cross(b, c));
  const Scalar larger = std::max(Scalar(abs(width)), Scalar(abs(height)));
  if (larger == 0) return kUntold;
  HalfAngle half;
  half.width = static_cast<double>(width / larger);
  half.height = static_cast<double>(height / larger);
  const Scalar error = ldexp(Scalar(1), 8 - kBits<Scalar>) / larger;
  half.error = error < 1 ? static_cast<double>(error) + kDoubleError : 1;
  half.length = std::sqrt(half.width * half.width + half.height * half.height);
  return half;
}

/// The angle found, knowing on which side of the plane the point is.
WindingShare share_of(const HalfAngle& half, int side) {
  WindingShare share;
  // Seen from behind, where `side` is -1, height is positive.
  const double height = std::max(0.0, -side * half.height);
  if (!(half.length > 2 * half.error)) {
    share.value = -side * 0.25;
    share.error = 0.25;
    return share;
  }
  share.value = -side * angle_of(half.width, height) * kOverTwoPi;
  // asin(e / l) is below (pi / 2) e / l, over 2 pi; 2^-50 is the angle's own.
  share.error = std::min(0.5, half.error / (half.length - half.error) * 0.25 + 0x1p-50);
  return share;
}


}  // namespace

WindingShare winding_share(const Point& point, const Triangle& triangle) noexcept {
  HalfAngle half = in_double(point, triangle);
  const bool side_told = std::fabs(half.height) > half.error;
  int side = half.height > 0 ? -1 : 1;
  if (!side_told) {
    if (lies_on(point, triangle)) return {0, 0, true};
    side = orientation(triangle[0], triangle[1], triangle[2], point);
    // In the plane, but not on the triangle; or there is no plane.
    if (side == 0) return {};
  }
  if (!half.tells_angle()) half = in_wide<Quad>(point, triangle);
  if (!half.tells_angle()) half = in_wide<Widest>(point, triangle);
  return share_of(half, side);
}

}  // namespace planetree::octree
