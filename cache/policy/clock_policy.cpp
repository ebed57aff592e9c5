#include "cache/policy/clock_policy.h"

#include <algorithm>

namespace planetree::cache {

std::uint32_t ClockPolicy::advance() noexcept {
  const std::uint32_t frame = hand_;
  hand_ = hand_ + 1 == scores_.size() ? 0 : hand_ + 1;
  return frame;
}

std::uint32_t ClockPolicy::choose_victim(const FrameStates& states) noexcept {
  // After this many rounds every score is 0 unless readers raised it in the meantime. They could
  // do so without end, so scores are ignored afterwards: one more round finds an evictable frame
  // if there is one.
  constexpr unsigned kScoredRounds = kUse * kMaxUses;
  const std::uint64_t scored_steps = std::uint64_t{kScoredRounds} * scores_.size();
  const std::uint64_t max_steps = scored_steps + scores_.size();
  const bool favours_upper = upper_count_ <= scores_.size() / 2;
  for (std::uint64_t step = 0; step < max_steps; ++step) {
    const std::uint32_t frame = advance();
    if (!states.is_evictable(frame)) continue;
    const std::uint8_t score = scores_[frame].load(std::memory_order_relaxed);
    if ((score & kScoreBits) == 0 || step >= scored_steps) return frame;
    const std::uint8_t loss = is_upper(score) && favours_upper ? 1 : kUse;
    const std::uint8_t lost = std::min<std::uint8_t>(loss, score & kScoreBits);
    scores_[frame].store(static_cast<std::uint8_t>(score - lost), std::memory_order_relaxed);
  }
  return kNoFrame;
}

}  // namespace planetree::cache
