#pragma once

#include <optional>

#include "octree/geometry/rigid_transform.h"
#include "planetree/contact.h"
#include "planetree/scene.h"
#include "query/scene/instance_table.h"

namespace planetree::query {

/// How an instance moves while a ball moves: its origin straight, its axes about a fixed axis, both
/// at constant speed. t goes from 0 to 1.
class PlacementMotion {
 public:
  /// Limit of the angle of a motion, in radians.
  static constexpr double kMaxAngle = 1;

  /// Returns nothing if the motion turns by more than kMaxAngle or leaves the range of poses.
  ///
  /// seconds  of the motion; 0: the instance stands still
  static std::optional<PlacementMotion> of(const Placement& start, double seconds);

  /// Whether the instance stands still where its model is.
  bool is_identity() const { return is_still_ && start_.is_identity(); }
  /// Its transform at a time from 0 to 1.
  octree::RigidTransform at(double t) const;

  /// A motion of a ball in the frame of the instance.
  struct LocalSweep {
    Sweep sweep;   ///< straight, from the first to the last position, with the ball's radius
    double error;  ///< bound on the distance between its centre and the true one, at any time
  };
  /// sweep  of finite numbers, with coordinates up to RigidTransform::kMaxCoordinate
  LocalSweep to_local(const Sweep& sweep) const;

  /// Bound on the way of the points of an instance that are no farther than `reach` from its
  /// origin.
  static double way_bound(const Twist& twist, double seconds, double reach);

 private:
  Placement placement_;
  double seconds_ = 0;
  double angle_ = 0;  // bound on the angle of the whole motion
  bool is_still_ = true;
  octree::RigidTransform start_, end_;
};

}  // namespace planetree::query
