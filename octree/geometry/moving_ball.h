#pragma once

#include <limits>

#include "octree/geometry/triangle_distance.h"

/// When a moving ball first touches a triangle.
///
/// Let d(t) be the distance from the centre at t to the triangle, which is convex in t, and r the
/// radius. For every vector n of length at most 1,
///
///     d(t) >= min over the corners c of n . (p(t) - c),
///
/// since a plane of normal n that has all corners behind it has the triangle behind it. The right
/// side is linear in t. So from a t at which the ball is free, the plane at the triangle's nearest
/// point, facing the centre, proves it free until the ball meets that plane; and that the speed is
/// bounded proves it free for (d - r) / speed. Over an edge the plane is turned to be along the
/// edge: close to it, rounding tilts the plane until it leaves an end of the edge before it. The
/// search takes the larger step until it gains nothing above rounding. It is Newton's method from
/// the left: above a face it takes one step, and over an edge or a vertex some four. It begins
/// where the plane across the motion is met.
///
/// source  conservative advancement, Mirtich 1996, "Impulse-based dynamic simulation of rigid body
///         systems", with separating planes in place of bounds on the velocity.
namespace planetree::octree {

class WorkLimit;

/// The time of a ball's first contact with one triangle.
struct ContactTime {
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  double lower = kNever;  ///< the ball certainly is free before; infinity: in all of the motion
  double upper = kNever;  ///< it certainly has touched by then; infinity if that is not certain
};

/// A ball whose centre goes straight from `from` to `to` while t goes from 0 to 1. Model frame, no
/// coordinate beyond kMaxQueryCoordinate.
class MovingBall {
 public:
  /// radius  >= 0
  MovingBall(const Point& from, const Point& to, double radius);

  /// Returns the centre at t, which errs by position_error() at most.
  Point at(double t) const { return from_ + t * way_; }
  double position_error() const { return position_error_; }
  const Point& from() const { return from_; }
  const Point& to() const { return to_; }
  const Point& way() const { return way_; }
  double radius() const { return radius_; }
  /// Upper bound on the length of the motion.
  double length() const { return length_; }

  /// Returns whether the plane that faces the ball at `start` proves it free until after `until`,
  /// by more than the uncertainty at which first_touch() stops.
  ///
  /// start    the ball is known to be free before
  /// nearest  nearest point of the triangle from at(start)
  bool is_free_until(const Triangle& triangle, double start, const NearestOnTriangle& nearest,
                     double until) const;

  /// Returns when the ball first touches a triangle. The result depends on the motion and the set
  /// of corners alone, not on their order.
  ///
  /// latest  if the ball is free until after `latest`, the result may be that it is free altogether
  /// limit   charged for each distance. If it refuses, which limit.exceeded() tells, `upper` is
  ///         infinity, and `lower` still holds.
  ContactTime first_touch(const Triangle& triangle, double latest, WorkLimit& limit) const noexcept;

 private:
  double free_step(const Triangle& triangle, const Point& centre, const NearestOnTriangle& nearest,
                   double margin = 0) const;
  bool touches(const NearestOnTriangle& nearest) const;
  double touched_by(const Triangle& triangle, double free_until, const NearestOnTriangle& nearest,
                    WorkLimit& limit) const;

  double free_across(const Triangle& triangle) const;

  const Point from_, to_, way_;
  const Point across_;  // against the motion, of length 1 less rounding; zero: no direction
  const double radius_, position_error_, length_;
};

}  // namespace planetree::octree
