#include "query/serve/motion_prefetch.h"

#include <algorithm>
#include <cassert>

namespace planetree::query {
namespace {

double speed2(const Motion& motion) {
  const Vec3& velocity = motion.velocity;
  return velocity.x * velocity.x + velocity.y * velocity.y + velocity.z * velocity.z;
}

}  // namespace

void MotionPrefetch::take(const Motion& motion, Seconds now) noexcept {
  const double max_speed2 = kMaxSpeedUp * kMaxSpeedUp * speed2(motion_);
  const bool is_jump = has_motion_ && !(speed2(motion) <= max_speed2);
  left_ = speed2(motion) > 0 && !is_jump ? kPositions : 0;
  if (has_motion_) compare_with_last(motion, now);
  motion_ = motion;
  has_motion_ = true;
  taken_at_ = now;
}

void MotionPrefetch::compare_with_last(const Motion& motion, Seconds now) noexcept {
  constexpr double kShare = 1.0 / 8;  // of the newest interval in the mean
  interval_ += kShare * (std::min(now - taken_at_, kMaxHorizon) - interval_);
  if (motion.side_searches != motion_.side_searches)
    motions_since_search_ = 0;
  else if (motions_since_search_ < kMotionsAfterSearch)
    ++motions_since_search_;
}

MotionPrefetch::Ahead MotionPrefetch::next(Seconds fetch_time) noexcept {
  assert(has_next());
  const Seconds horizon = std::clamp(2 * (fetch_time + interval_), kMinHorizon, kMaxHorizon);
  const unsigned at = kPositions - --left_;
  const double time = horizon.count() * at / kPositions;
  const Vec3 &from = motion_.position, &velocity = motion_.velocity;
  return {{from.x + velocity.x * time, from.y + velocity.y * time, from.z + velocity.z * time},
          motions_since_search_ < kMotionsAfterSearch,
          motion_.parts,
          motion_.side_rule};
}

}  // namespace planetree::query
