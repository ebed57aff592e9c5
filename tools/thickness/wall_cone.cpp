#include "tools/thickness/wall_cone.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/mesh/mesh_pieces.h"

namespace planetree::tools {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Above the errors of unit normals and of the operations here.
constexpr double kAngleSlack = 0x1p-36;
// Above the rounding of surface points, as a share of the coordinates.
constexpr double kRounding = 0x1p-46;

double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

}  // namespace

WallCone::WallCone(const Vec3& apex, const Vec3& axis, double sine, double scale)
    : apex_(apex), axis_(axis), sine_(sine), scale_(scale) {}

Vec3 WallCone::centre(double radius) const {
  return {apex_.x + radius * axis_.x, apex_.y + radius * axis_.y, apex_.z + radius * axis_.z};
}

double WallCone::radius_to(const Vec3& point) const {
  const Vec3 way = point - apex_;
  const double rise = dot(axis_, way), length = length_of(way);
  if (!(length > kTolerance * scale_) || !(rise >= sine_ * length)) return kInfinity;
  return length / 2 * (length / rise);
}

// Let the plane be at the height h > 0 from the apex, along the normal m, and u a direction of the
// cone of elevation a. It meets the plane at the distance h / m.u, with the radius h / (2 sin(a)
// m.u). Among the directions of one elevation m.u is greatest in the plane of m and the axis n:
// m.u = m.n sin(a) + sqrt(1 - (m.n)^2) cos(a). The radius is least where the ball touches the
// plane, at sin(a)^2 = (1 + m.n) / 2, and grows from there. If that is below the cone, it is least
// at the cone's rim.
double WallCone::least_radius_to_plane(const Vec3& point, const Vec3& normal) const {
  double height = dot(normal, point - apex_);
  double along = dot(normal, axis_);
  if (height < 0) along = -along;
  height = std::fabs(height);
  const double sine = sine_ - kAngleSlack, cosine = std::sqrt(1 - sine * sine);
  // Through the apex: the plane rises by the angle between the normals at most.
  if (height <= kTolerance * scale_) return std::fabs(along) >= cosine ? kInfinity : 0;
  height -= kRounding * scale_;
  along = std::clamp(along + kAngleSlack, -1.0, 1.0);
  if ((1 + along) / 2 >= sine * sine) return height / (1 + along);
  const double towards = along * sine + std::sqrt(1 - along * along) * cosine;
  return towards > 0 ? height / (2 * sine * towards) : kInfinity;
}

// A point of the cone that the ball of radius s < r reaches is at the distance d from the centre of
// the ball of radius r, where d^2 = r^2 - 4 (r - s) s sin(a)^2. So d >= r - depth gives
// (r - s) s <= r depth / (2 sin(a)^2). Hence s <= depth / sin(a)^2 or s >= r - depth / sin(a)^2.
double WallCone::hidden(double depth) const { return std::max(0.0, depth) / (sine_ * sine_); }

// A point at a radius below hidden() of this is nearer to the apex than the tolerance.
double WallCone::allowed_depth() const { return kTolerance * scale_ * sine_ * sine_ / 4; }

double WallCone::least_radius_in_empty(double radius) const {
  return std::max(0.0, radius - hidden(allowed_depth()));
}

// The gradient of the radius by the point is v / (n.v) - |v|^2 n / (2 (n.v)^2), for v = q - apex.
double WallCone::rounding() const {
  return 2 * kRounding * scale_ * (1 / sine_ + 1 / (2 * sine_ * sine_));
}

}  // namespace planetree::tools
