#include "octree/geometry/angles.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/predicates.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/wide_numbers.h"
#include "octree/geometry/work_limit.h"

namespace planetree::octree {
namespace {

constexpr double kHalfPi = 0x1.921fb54442d18p+0;

/// kArctangents[k] is the arctangent of k / 8.
constexpr std::array<double, 9> kArctangents = {
    0x0.0p+0,
    0x1.fd5ba9aac2f6ep-4,
    0x1.f5b75f92c80ddp-3,
    0x1.6f61941e4def1p-2,
    0x1.dac670561bb4fp-2,
    0x1.1e00babdefeb4p-1,
    0x1.4978fa3269ee1p-1,
    0x1.700a7c5784634p-1,
    0x1.921fb54442d18p-1,
};

/// Returns the arctangent of t, 0 <= t <= 1. It is the arctangent of the nearest eighth c plus a
/// series for x = (t - c) / (1 + t c), which is at most 1/16. The first omitted term is below 2^-68
/// / 17.
double arctangent(double t) {
  const std::size_t eighth = (static_cast<std::size_t>(t * 16) + 1) / 2;
  const double c = static_cast<double>(eighth) / 8;
  const double x = (t - c) / (1 + t * c);
  const double x2 = x * x;
  double sum = 0;
  for (int power = 15; power >= 3; power -= 2) sum = x2 * (1.0 / power - sum);
  return kArctangents[eighth] + (x - x * sum);
}

}  // namespace

double angle_of(double along, double across) noexcept {
  const double ahead = std::fabs(along);
  const double acute =
      across <= ahead ? arctangent(across / ahead) : kHalfPi - arctangent(ahead / across);
  return along >= 0 ? acute : 2 * kHalfPi - acute;
}

double angle_between(const Point& u, const Point& v) noexcept {
  // Scaled to a length of about 1, so that no product overflows or underflows.
  const Point a = u / u.cwiseAbs().maxCoeff(), b = v / v.cwiseAbs().maxCoeff();
  return angle_of(a.dot(b), a.cross(b).norm());
}

namespace {

constexpr double kOverTwoPi = 0x1.45f306dc9c883p-3;  ///< 1 / (2 pi)

/// Vector whose angle is half of the solid angle omega: tan(omega / 2) = height / width. With a, b,
/// c the vectors from the point to the corners,
///
///     height = a . (b x c),   width = |a||b||c| + a . b |c| + b . c |a| + c . a |b|.
///
/// If the vector's end is off by `error`, the angle is off by at most asin(error / true length).
struct HalfAngle {
  double width = 0;
  double height = 0;
  double error = 0;   ///< bound on the distance from (width, height) to the true end
  double length = 0;  ///< length of (width, height)

  bool is_precise() const { return error < kMaxHalfAngleError * length; }
};

constexpr HalfAngle kUncertain{0, 0, 1, 0};

HalfAngle half_angle_in_double(const Point& point, const Triangle& triangle) {
  const Point a = triangle[0] - point, b = triangle[1] - point, c = triangle[2] - point;
  const double a2 = a.squaredNorm(), b2 = b.squaredNorm(), c2 = c.squaredNorm();
  if (!(std::min({a2, b2, c2}) > kMinAngleLength2 && std::max({a2, b2, c2}) < kMaxAngleLength2))
    return kUncertain;
  const double a1 = std::sqrt(a2), b1 = std::sqrt(b2), c1 = std::sqrt(c2);
  HalfAngle half;
  half.width = a1 * b1 * c1 + a.dot(b) * c1 + b.dot(c) * a1 + c.dot(a) * b1;
  half.height = a.dot(b.cross(c));
  half.error = kHalfAngleError * (a1 * b1 * c1);
  half.length = std::sqrt(half.width * half.width + half.height * half.height);
  return half;
}

/// Returns the unit vector from one point to another.
template <class Scalar>
Vector3<Scalar> wide_direction(const Point& from, const Point& to) {
  Vector3<Scalar> way;
  for (unsigned axis = 0; axis < 3; ++axis)
    way[axis] = wide<Scalar>(to[axis]) - wide<Scalar>(from[axis]);
  const Scalar length = sqrt(dot(way, way));
  for (Scalar& component : way) component /= length;
  return way;
}

/// Computes the same in wider numbers, from unit vectors. `point` differs from every corner. The
/// result is scaled to a length of about 1.
template <class Scalar>
HalfAngle half_angle_in_wide(const Point& point, const Triangle& triangle) {
  const auto a = wide_direction<Scalar>(point, triangle[0]);
  const auto b = wide_direction<Scalar>(point, triangle[1]);
  const auto c = wide_direction<Scalar>(point, triangle[2]);
  const Scalar width = 1 + dot(a, b) + dot(b, c) + dot(c, a);
  const Scalar height = dot(a, cross(b, c));
  const Scalar larger = std::max(Scalar(abs(width)), Scalar(abs(height)));
  if (larger == 0) return kUncertain;
  HalfAngle half;
  half.width = static_cast<double>(width / larger);
  half.height = static_cast<double>(height / larger);
  const Scalar error = ldexp(Scalar(1), kWideHalfAngleErrorBits - kBits<Scalar>) / larger;
  half.error = error < 1 ? static_cast<double>(error) + kHalfAngleError : 1;
  half.length = std::sqrt(half.width * half.width + half.height * half.height);
  return half;
}

/// What is known of every share.
constexpr WindingShare kAnyShare{0, 0.5, false};

/// Converts the vector to a share, given the side of the plane that the point is on.
WindingShare share_of(const HalfAngle& half, int side) {
  WindingShare share;
  // From behind, where `side` is -1, the height is positive.
  const double height = std::max(0.0, -side * half.height);
  if (!(half.length > 2 * half.error)) {
    share.value = -side * 0.25;
    share.error = 0.25;
    return share;
  }
  share.value = -side * angle_of(half.width, height) * kOverTwoPi;
  share.error =
      std::min(0.5, half.error / (half.length - half.error) * kAsinOverTwoPi + kAngleError);
  return share;
}

}  // namespace

WindingShare winding_share(const Point& point, const Triangle& triangle,
                           WorkLimit* limit) noexcept {
  const auto may_take = [limit](std::uint64_t units) { return !limit || limit->try_take(units); };
  HalfAngle half = half_angle_in_double(point, triangle);
  const bool side_is_certain = std::fabs(half.height) > half.error;
  int side = half.height > 0 ? -1 : 1;
  if (!side_is_certain) {
    if (!may_take(WorkUnits::kExactCrossing)) return kAnyShare;
    const bool on_surface = lies_on(point, triangle, limit);
    if (!on_surface) side = orientation(triangle[0], triangle[1], triangle[2], point, limit);
    if (limit && limit->exceeded()) return kAnyShare;
    if (on_surface) return {0, 0, true};
    // The point is in the plane but not on the triangle, or the triangle has no area.
    if (side == 0) return {};
  }
  if (!half.is_precise() && may_take(WorkUnits::kQuadAngle))
    half = half_angle_in_wide<Quad>(point, triangle);
  if (!half.is_precise() && may_take(WorkUnits::kWidestAngle))
    half = half_angle_in_wide<Widest>(point, triangle);
  return share_of(half, side);
}

}  // namespace planetree::octree
