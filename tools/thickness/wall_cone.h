#pragma once

#include <cstdint>

#include "planetree/types.h"

namespace planetree::tools {

/// Where the opposite side of a wall is looked for: the directions from a point of the surface that
/// rise above its tangent plane by at least an angle, into the solid.
///
/// Balls here touch the tangent plane at the apex, on the side of the axis. Such a ball has a
/// centre of apex + radius * axis. It reaches a point q when its radius is |q - apex|^2 / (2
/// axis.(q - apex)).
class WallCone {
 public:
  /// axis   of length 1
  /// sine   of the angle, from 0.05 to 0.99
  /// scale  the greatest coordinate of the model, model units. Points and planes nearer to the apex
  ///        than kTolerance of it belong to the surface at the apex.
  WallCone(const Vec3& apex, const Vec3& axis, double sine, double scale);

  static constexpr double kTolerance = 0x1p-34;

  const Vec3& apex() const { return apex_; }
  /// The centre of a ball.
  Vec3 centre(double radius) const;
  /// The radius of the ball that reaches a point. Infinite if the point is outside of the cone.
  double radius_to(const Vec3& point) const;
  /// A lower bound of the radius for all points of the cone that lie in a plane. Infinite if there
  /// are none.
  ///
  /// point, normal  of the plane; the normal has length 1 and either sign
  double least_radius_to_plane(const Vec3& point, const Vec3& normal) const;
  /// How the surface in a ball hides points of the cone: if none of it is deeper than `depth`, the
  /// ball reaches a point of the cone only at a radius of at most the return value, or of at least
  /// its own without that. Holds if the return value is at most half the radius.
  double hidden(double depth) const;
  /// How deep the surface may be in a ball that counts as empty.
  double allowed_depth() const;
  /// A lower bound of the radius for all points of the cone, if the ball of `radius` is empty but
  /// for allowed_depth().
  double least_radius_in_empty(double radius) const;
  /// By how much the rounding of apex and point changes a radius at most.
  double rounding() const;

 private:
  Vec3 apex_, axis_;
  double sine_, scale_;
};

}  // namespace planetree::tools
