#pragma once

#include "planetree/types.h"

/// @file
/// Where a rigid body is and how it is turned.

namespace planetree {

/// A rotation: the unit quaternion w + x i + y j + z k. A quaternion and its negative are the same
/// rotation. The default rotates nothing.
struct Quaternion {
  double w = 1,  ///< real part
      x = 0,     ///< coefficient of i
      y = 0,     ///< coefficient of j
      z = 0;     ///< coefficient of k
};

/// The position and the orientation of a rigid body. It maps a point p of the body's frame to
/// rotation * p + translation, in the model's frame.
///
/// A quaternion of doubles is rarely of length 1 to the last bit. The rotation is that of the
/// quaternion divided by its length. Error bounds that depend on a pose also hold for the body
/// rotated without that division, and for the pose whose numbers rounded to these. So they grow
/// with the distance of the squared length from 1. A pose is valid if that distance is at most
/// kMaxLengthError, and if every number is finite and no coordinate of the translation is above
/// 2^500. A quaternion of floats, divided by its length, is valid.
struct Pose {
  Quaternion rotation;  ///< of the body's frame, about its origin
  Vec3 translation;     ///< position of the body's origin, model units

  /// Limit of | |rotation|^2 - 1 |.
  static constexpr double kMaxLengthError = 0x1p-20;
};

}  // namespace planetree
