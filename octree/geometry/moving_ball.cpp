#include "octree/geometry/moving_ball.h"

#include <algorithm>
#include <cmath>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/line_crossing.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/work_limit.h"

namespace planetree::octree {
namespace {

constexpr int kMaxSteps = 64;  // of the search for each end of the interval

double largest(const Point& vector) { return vector.cwiseAbs().maxCoeff(); }

// A unit vector against a way.
Point against(const Point& way) {
  const double length = way.norm();
  return length > kUnresolvedLength ? Point(way * ((kNormRounding - 1) / length))
                                    : Point(Point::Zero());
}

// Returns a lower bound on the height of all corners below a point, along a vector of length 1 at
// most.
double height_over(const Triangle& triangle, const Point& centre, const Point& normal) {
  double height = std::numeric_limits<double>::infinity(), farthest = 0;
  for (const Point& corner : triangle) {
    const Point from = centre - corner;
    height = std::min(height, normal.dot(from));
    farthest = std::max(farthest, largest(from));
  }
  return height - kPlaneRounding * farthest;
}

// Returns a vector across the edge that a nearest point is on, and the vector itself if that point
// is on no edge. Close to an edge, rounding tilts the vector to the nearest point so far that the
// ends of the edge are above the plane.
Point across_edge(const Triangle& triangle, const NearestOnTriangle& nearest, const Point& toward) {
  if (nearest.feature != Feature::kEdge) return toward;
  for (std::size_t k = 0; k < 3; ++k) {
    if (nearest.barycentric[k] > 0) continue;
    const Point edge = triangle[(k + 2) % 3] - triangle[(k + 1) % 3];
    if (edge.norm() > kUnresolvedLength) return toward - edge * (toward.dot(edge) / edge.dot(edge));
  }
  return toward;
}

}  // namespace

MovingBall::MovingBall(const Point& from, const Point& to, double radius)
    : from_(from),
      to_(to),
      way_(to - from),
      across_(against(way_)),
      radius_(radius),
      position_error_(kPositionRounding * std::max(largest(from), largest(to))),
      length_(way_.norm() * (1 + kNormRounding) + kUnresolvedLength) {}

// Returns a t until which the plane across the motion proves the ball free; may be negative.
double MovingBall::free_across(const Triangle& triangle) const {
  const double clear =
      height_over(triangle, from_, across_) - radius_ * (1 + kPlaneRounding) - position_error_;
  return clear > 0 ? clear / length_ * (1 - kEndRounding) : 0;
}

bool MovingBall::touches(const NearestOnTriangle& nearest) const {
  const double distance = std::sqrt(nearest.value.squared);
  return (distance + nearest.value.error + position_error_) * (1 + kEndRounding) <= radius_;
}

// Returns how far t may go on without contact; infinity if there is none at all.
//
// margin  added to the radius
double MovingBall::free_step(const Triangle& triangle, const Point& centre,
                             const NearestOnTriangle& nearest, double margin) const {
  const double distance = std::sqrt(nearest.value.squared);
  const double gap =
      distance - nearest.value.error - position_error_ - radius_ - margin - distance * kEndRounding;
  double step = gap > 0 ? gap / length_ : 0;

  const Point toward = across_edge(triangle, nearest, centre - nearest.point);
  const double length = toward.norm();
  if (!(length > kUnresolvedLength)) return step;
  const Point normal = toward * ((1 - kNormRounding) / length);
  const double clear =
      height_over(triangle, centre, normal) - radius_ * (1 + kPlaneRounding) - position_error_;
  if (!(clear > 0)) return step;
  const double closing = kPlaneRounding * largest(way_) - normal.dot(way_);
  return closing > 0 ? std::max(step, clear / closing) : ContactTime::kNever;
}

// Returns a t by which the ball has touched the triangle; infinity if none was found.
//
// nearest  from at(free_until)
double MovingBall::touched_by(const Triangle& triangle, double free_until,
                              const NearestOnTriangle& nearest, WorkLimit& limit) const {
  if (touches(nearest)) return free_until;
  const double uncertainty = nearest.value.error + position_error_;
  const Point toward = at(free_until) - nearest.point;
  const double closing = -toward.dot(way_) / std::max(toward.norm(), kUnresolvedLength);
  const double depth = std::sqrt(nearest.value.squared) - radius_ + 4 * uncertainty;
  double step = std::max(depth, uncertainty) / std::max(closing, length_ * kMinClosingShare);
  for (int i = 0; i < kMaxSteps && free_until < 1; ++i, step *= 2) {
    const double t = std::min(free_until + step, 1.0);
    NearestOnTriangle there;
    if (!limit.try_take(WorkUnits::kBallStep) ||
        !nearest_on_triangle(at(t), triangle, limit, there))
      return ContactTime::kNever;
    if (touches(there)) return t;
    const bool is_leaving = (at(t) - there.point).dot(way_) > 0;
    if (t == 1 || (is_leaving && std::sqrt(there.value.squared) > radius_)) break;
  }
  // A ball too small for distances to be certain is there when its centre passes through.
  const LineCrossing crossing = cross({from_, to_, from_}, {free_until, 1}, triangle, &limit);
  return crossing.sign != 0 && !limit.exceeded()
             ? std::min(1.0, (crossing.t + crossing.error) * (1 + kEndRounding))
             : ContactTime::kNever;
}

bool MovingBall::is_free_until(const Triangle& triangle, double start,
                               const NearestOnTriangle& nearest, double until) const {
  const double margin = 8 * (nearest.value.error + position_error_);
  return start + free_step(triangle, at(start), nearest, margin) * (1 - kNormRounding) > until;
}

ContactTime MovingBall::first_touch(const Triangle& triangle, double latest,
                                    WorkLimit& limit) const noexcept {
  // A long way from the triangle, the planes that face the ball would prove little.
  double free_until = free_across(triangle);
  if (free_until > 1 || free_until > latest) return {};
  NearestOnTriangle nearest;
  if (!limit.try_take(WorkUnits::kBallStep) ||
      !nearest_on_triangle(at(free_until), triangle, limit, nearest))
    return {free_until, ContactTime::kNever};
  for (int i = 0; i < kMaxSteps && !touches(nearest); ++i) {
    const double step = free_step(triangle, at(free_until), nearest);
    if (!(step > 0)) break;
    const double next = (free_until + step) * (1 - kEndRounding);
    if (next > 1 || next > latest) return {};
    if (!(next > free_until)) break;
    const bool gains = (next - free_until) * length_ > 4 * (nearest.value.error + position_error_);
    free_until = next;
    if (!limit.try_take(WorkUnits::kBallStep) ||
        !nearest_on_triangle(at(free_until), triangle, limit, nearest))
      return {free_until, ContactTime::kNever};
    if (!gains) break;
  }
  return {free_until, touched_by(triangle, free_until, nearest, limit)};
}

}  // namespace planetree::octree
