#include "tools/session/ball_proxy.h"

#include <algorithm>
#include <cmath>

namespace planetree::tools {
namespace {

Vec3 sum(const Vec3& a, const Vec3& b, double times) {
  return {a.x + b.x * times, a.y + b.y * times, a.z + b.z * times};
}
double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(const Vec3& a) { return std::sqrt(dot(a, a)); }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// The part of a motion that leads along one face or, at a second contact, along the edge between
// two.
Vec3 along(const Vec3& motion, const Vec3* before, const Vec3& normal) {
  if (before) {
    const Vec3 edge = cross(*before, normal);
    const double size2 = dot(edge, edge);
    if (size2 > 1e-12) return sum({}, edge, dot(motion, edge) / size2);
  }
  return sum(motion, normal, -std::min(0.0, dot(motion, normal)));
}

// The direction of length 1 in which the surface falls behind. It needs no normal, which answers of
// the distance alone do not have, unless the place is on the surface.
Vec3 outward_of(const ClosestPoint& nearest, const Vec3& place) {
  if (!(nearest.distance > 0)) return nearest.normal;
  const Vec3 way = sum(place, nearest.point, -1);
  return sum({}, way, 1 / std::copysign(length(way), nearest.signed_distance()));
}

}  // namespace

BallProxy::Tick BallProxy::follow(TouchProbe probe, const Vec3& device,
                                  const QueryOptions& options) noexcept {
  Tick tick;
  advance(probe, device, options, tick);
  return tick;
}

BallProxy::Tick BallProxy::follow_among_moving(TouchProbe probe, const Vec3& device,
                                               const QueryOptions& options) noexcept {
  Tick tick;
  give_way(probe, options, tick);
  advance(probe, device, options, tick);
  return tick;
}

void BallProxy::put(TouchProbe probe, const Vec3& place) {
  constexpr int kMaxSteps = 64;
  const Vec3 outward = probe.closest_point(place).normal;
  double height = 0;
  for (int i = 0; i < kMaxSteps; ++i) {
    centre_ = sum(place, outward, height);
    const ClosestPoint nearest = probe.closest_point(centre_);
    if (nearest.signed_distance() > radius_ + gap_) return;
    height = std::max(2 * height, radius_ + 2 * gap_);
  }
}

void BallProxy::give_way(TouchProbe probe, const QueryOptions& options, Tick& tick) noexcept {
  constexpr int kMaxSteps = 8;
  for (int step = 0; step < kMaxSteps; ++step) {
    const SceneClosestPoint nearest = probe.closest_point(centre_, options);
    const double lower = nearest.side == Side::kInside ? -nearest.upper : nearest.lower;
    if (lower >= radius_ + gap_ / 2) return;
    if (nearest.status != Status::kExact) {
      tick.status = Status::kDegraded;
      tick.lag = std::max(tick.lag, radius_ + gap_ - lower);
      return;
    }
    const double depth = radius_ + gap_ - nearest.signed_distance();
    centre_ = sum(centre_, outward_of(nearest, centre_), depth);
    tick.touches = true;
    tick.instance = nearest.instance;
  }
}

void BallProxy::advance(TouchProbe probe, const Vec3& device, const QueryOptions& options,
                        Tick& tick) noexcept {
  Vec3 motion = sum(device, centre_, -1), before;
  for (int move = 0; move < kMaxMoves; ++move) {
    const double way = length(motion);
    if (!(way > gap_)) break;
    const SceneFirstContact contact =
        probe.first_contact({centre_, sum(centre_, motion, 1), radius_}, options);
    const double free = std::min(1.0, contact.t_lower);
    if (contact.status == Status::kDegraded) {
      tick.status = Status::kDegraded;
      tick.lag = std::max(tick.lag, (1 - free) * way);
    }
    const double share = contact.free ? 1 : std::max(0.0, free - gap_ / way);
    centre_ = sum(centre_, motion, share);
    if (contact.free || contact.status == Status::kDegraded) break;
    tick.touches = true;
    tick.instance = contact.instance;
    const Vec3 normal = contact.at.normal;
    motion = along(sum({}, motion, 1 - share), move > 0 ? &before : nullptr, normal);
    before = normal;
  }
}

}  // namespace planetree::tools
