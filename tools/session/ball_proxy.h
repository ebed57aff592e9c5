#pragma once

#include "tools/session/touch_probe.h"

namespace planetree::tools {

/// The ball of a haptic tool that follows a device and never enters the surface: where the device
/// is inside, the ball stays outside and slides along. A spring between the two gives the force.
///
/// Each move is a first contact, so that a ball passes through no wall, however thin, and however
/// fast the device is. Where pages are missing, the ball moves as far as is certainly free.
///
/// source  god-object method, Zilles and Salisbury 1995; proxies of finite size, Ruspini et al.
///         1997.
class BallProxy {
 public:
  /// What one tick came to.
  struct Tick {
    Status status = Status::kExact;     ///< kDegraded if a move was cut short because pages lacked
    double lag = 0;                     ///< of a degraded tick: length that is not known to be free
    bool touches = false;               ///< the surface stopped the ball
    InstanceId instance = kNoInstance;  ///< of a scene: the one that stopped the ball last
  };

  /// radius  model units, above 0
  /// gap     distance that the ball keeps from the surface, model units, above 0
  BallProxy(double radius, double gap) : radius_(radius), gap_(gap) {}

  /// Puts the ball where it is free: at a place, or so far from it along its normal out of the
  /// solid. Not for real time.
  void put(TouchProbe probe, const Vec3& place);
  /// Moves the ball towards the device. `options` are those of its queries.
  Tick follow(TouchProbe probe, const Vec3& device, const QueryOptions& options) noexcept;
  /// The same where the surface may have moved since the last tick: first the ball gives way to
  /// what has come nearer than the gap. Where surfaces squeeze it from both sides, it stays in one
  /// of them. It asks for sides if `options` do.
  Tick follow_among_moving(TouchProbe probe, const Vec3& device,
                           const QueryOptions& options) noexcept;

  const Vec3& centre() const { return centre_; }
  double radius() const { return radius_; }

 private:
  void give_way(TouchProbe probe, const QueryOptions& options, Tick& tick) noexcept;
  void advance(TouchProbe probe, const Vec3& device, const QueryOptions& options,
               Tick& tick) noexcept;

  static constexpr int kMaxMoves = 3;  // straight on, along a face, along an edge between two

  const double radius_, gap_;
  Vec3 centre_;
};

}  // namespace planetree::tools
