#pragma once

#include <cmath>
#include <optional>

#include "octree/geometry/error_bounds.h"
#include "planetree/pose.h"
#include "planetree/types.h"

namespace planetree::octree {

/// The rotation by `b`, then by `a`.
constexpr Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

/// Maps points and directions of a body's frame by a pose, with a bound on the error.
///
/// Let q be the quaternion, n = |q|^2, R the rotation of q / |q|, and u = 2^-53.
///
/// 1. n is a sum of four squares, so that its computed value errs by 4 u of itself, and s = 2 / n
/// by
///    5.1 u.
/// 2. An entry of the diagonal of R is 1 - s (a^2 + b^2). The sum errs by 2 u, its product with s
///    by 8.2 u in all, of at most 2; the difference by u. Together 17.5 u.
/// 3. Another entry is s (a b +- c d), where |a b| + |c d| <= n / 2. Products and sum err by 2 u of
///    that, so the product with s by 2 u + 6.2 u = 8.2 u.
/// 4. The error of the matrix has the Frobenius norm sqrt(3 * 17.5^2 + 6 * 8.2^2) u < 37 u.
/// 5. A row times p errs by 3.1 u |p|, three rows by 5.4 u |p|. Adding the translation t errs by u
///    of the result, at most 1.1 u (|p| + |t|).
///
/// So R p + t errs by less than 44 u |p| + 2 u |t|. The other meanings of a pose add to that:
///
/// - Without the division the matrix is R + (n - 1) (R - I), or n R. Both differ from R by at most
///   2 |n - 1|. The computed n - 1 errs by 4.1 u, which adds 8.2 u |p|.
/// - If q was rounded from a unit quaternion, each of its numbers moved by at most u / 2, together
///   by u. That turns by at most 2 u, and moves p by 2 u |p|. Rounding moves t by at most u |t|.
///
/// The sum is below (55 u + 2 |n - 1|) |p| + 3 u |t|. The bound is (64 u + 2 |n - 1|) |p| + 4 u
/// |t|, and an absolute term for products that underflow.
///
/// The inverse maps p to R^T (p - t). The difference errs by u |p - t|, the transposed matrix by as
/// much as the matrix, and its product by 5.4 u |p - t|; a translation that was rounded adds u |t|.
/// So the same bound holds with |p - t| in the place of |p|.
class RigidTransform {
 public:
  /// Limit of the coordinates of points, and of those of a translation.
  static constexpr double kMaxCoordinate = 0x1p500;

  /// Whether the coordinates of a point are at most kMaxCoordinate.
  static bool is_in_range(const Vec3& p) {
    return std::fabs(p.x) <= kMaxCoordinate && std::fabs(p.y) <= kMaxCoordinate &&
           std::fabs(p.z) <= kMaxCoordinate;
  }

  /// Returns nothing if the pose is not valid; see Pose.
  static std::optional<RigidTransform> of(const Pose& pose);

  /// Maps a point whose coordinates are at most kMaxCoordinate.
  Vec3 apply(const Vec3& p) const {
    const Vec3 turned = rotate(p);
    return {turned.x + translation_.x, turned.y + translation_.y, turned.z + translation_.z};
  }
  /// Maps a point of the model's frame to the body's frame: the inverse of apply(). Coordinates are
  /// at most kMaxCoordinate.
  Vec3 apply_inverse(const Vec3& p) const {
    return rotate_inverse({p.x - translation_.x, p.y - translation_.y, p.z - translation_.z});
  }
  /// Whether points stay as they are: no rotation and no translation, without any error.
  bool is_identity() const { return is_identity_; }
  const Vec3& translation() const { return translation_; }
  /// Maps a direction to the body's frame: R^T p.
  Vec3 rotate_inverse(const Vec3& p) const {
    return {row_x_.x * p.x + row_y_.x * p.y + row_z_.x * p.z,
            row_x_.y * p.x + row_y_.y * p.y + row_z_.y * p.z,
            row_x_.z * p.x + row_y_.z * p.y + row_z_.z * p.z};
  }
  /// Maps the half extents of a box to those of the box around it when it is turned.
  Vec3 rotate_extents(const Vec3& h) const {
    const auto sum = [&h](const Vec3& row) {
      return std::fabs(row.x) * h.x + std::fabs(row.y) * h.y + std::fabs(row.z) * h.z;
    };
    return {sum(row_x_), sum(row_y_), sum(row_z_)};
  }
  /// Maps a direction: R p.
  Vec3 rotate(const Vec3& p) const {
    return {row_x_.x * p.x + row_x_.y * p.y + row_x_.z * p.z,
            row_y_.x * p.x + row_y_.y * p.y + row_y_.z * p.z,
            row_z_.x * p.x + row_z_.y * p.y + row_z_.z * p.z};
  }
  /// Bound on the distance of apply(p) from the true position, for |p| <= reach. The same of
  /// apply_inverse(p), for |p - t| <= reach.
  double position_error(double reach) const {
    return rotation_error_ * reach + translation_error_ + kUnresolvedLength;
  }
  /// Bound on |rotate(p) - true direction|, as a share of |p|.
  double rotation_error() const { return rotation_error_; }

 private:
  Vec3 row_x_, row_y_, row_z_;
  Vec3 translation_;
  double rotation_error_ = 0;     // as a share of |p|
  double translation_error_ = 0;  // model units
  bool is_identity_ = false;
};

}  // namespace planetree::octree
