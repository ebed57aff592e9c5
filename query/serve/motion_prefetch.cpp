#include "query/serve/motion_prefetch.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace planetree::query {
namespace {

double length2(const Vec3& a) { return a.x * a.x + a.y * a.y + a.z * a.z; }

double speed2(const Motion& motion) { return length2(motion.velocity); }

Vec3 sum(const Vec3& a, const Vec3& b, double times) {
  return {a.x + b.x * times, a.y + b.y * times, a.z + b.z * times};
}

}  // namespace

// Whether a motion is not much faster than another.
bool MotionPrefetch::is_as_fast(const Motion& motion, const Motion& other) noexcept {
  return speed2(motion) <= kMaxSpeedUp * kMaxSpeedUp * speed2(other);
}

void MotionPrefetch::take(const Motion& motion, Seconds now) noexcept {
  const bool is_jump = has_motion_ && !is_as_fast(motion, motion_);
  left_ = speed2(motion) > 0 && !is_jump ? kPositions : 0;
  change_ = {};
  if (has_motion_) compare_with_last(motion, now);
  motion_ = motion;
  has_motion_ = true;
  taken_at_ = now;
}

void MotionPrefetch::compare_with_last(const Motion& motion, Seconds now) noexcept {
  constexpr double kShare = 1.0 / 8;  // of the newest interval in the mean
  interval_ += kShare * (std::min(now - taken_at_, kMaxHorizon) - interval_);
  // The velocity of a jump tells nothing about the turn.
  if (is_as_fast(motion_, motion)) change_ = sum(motion.velocity, motion_.velocity, -1);
  if (motion.side_searches != motion_.side_searches)
    motions_since_search_ = 0;
  else if (motions_since_search_ < kMotionsAfterSearch)
    ++motions_since_search_;
}

// Returns by how far the probe leaves the straight line. A velocity that is not known well changes
// without turning the probe, so the turn is at most as long as the way.
Vec3 MotionPrefetch::turned(Seconds time) const noexcept {
  if (!(interval_.count() > 0)) return {};
  const double times = time.count() * time.count() / (2 * interval_.count());
  const double way2 = speed2(motion_) * time.count() * time.count();
  const double turn2 = length2(change_) * times * times;
  return sum({}, change_, turn2 > way2 ? times * std::sqrt(way2 / turn2) : times);
}

// number  1 to kPositions
Vec3 MotionPrefetch::position(unsigned number, Seconds fetch_time) const noexcept {
  const Seconds horizon = std::clamp(2 * (fetch_time + interval_), kMinHorizon, kMaxHorizon);
  const Seconds time = horizon * number / kPositions;
  const Vec3 straight = sum(motion_.position, motion_.velocity, time.count());
  return number < kPositions ? sum(straight, turned(time), 1) : straight;
}

std::span<const Vec3> MotionPrefetch::left(Seconds fetch_time,
                                           std::span<Vec3> positions) const noexcept {
  assert(positions.size() >= left_);
  for (unsigned i = 0; i < left_; ++i)
    positions[i] = position(kPositions - left_ + i + 1, fetch_time);
  return positions.first(left_);
}

MotionPrefetch::Ahead MotionPrefetch::next(Seconds fetch_time) noexcept {
  assert(has_next());
  const Vec3 position = this->position(kPositions - --left_, fetch_time);
  return {position, motions_since_search_ < kMotionsAfterSearch, motion_.parts, motion_.side_rule};
}

}  // namespace planetree::query
