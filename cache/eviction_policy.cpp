#include "cache/eviction_policy.h"

#include <algorithm>
#include <utility>

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
    if (states.of(frame) != FrameStates::State::kEvictable) continue;
    const std::uint8_t score = scores_[frame].load(std::memory_order_relaxed);
    if ((score & kScoreBits) == 0 || step >= scored_steps) return frame;
    const std::uint8_t loss = is_upper(score) && favours_upper ? 1 : kUse;
    const std::uint8_t lost = std::min<std::uint8_t>(loss, score & kScoreBits);
    scores_[frame].store(static_cast<std::uint8_t>(score - lost), std::memory_order_relaxed);
  }
  return kNoFrame;
}

bool LruPolicy::is_before(std::uint32_t frame, std::uint32_t other) const noexcept {
  const std::uint64_t last_use = entries_[frame].last_use, other_use = entries_[other].last_use;
  return last_use != other_use ? last_use < other_use : frame < other;
}

void LruPolicy::install(std::uint32_t frame) noexcept {
  const std::uint64_t time = now_[0].load(std::memory_order_relaxed) + 1;
  now_[0].store(time, std::memory_order_relaxed);
  uses_[frame].store(time, std::memory_order_relaxed);
  push(frame);
}

// A frame may still be in the heap from before it was removed or held. The last use read then is
// too old, which choose_victim() corrects when the frame reaches the top.
void LruPolicy::push(std::uint32_t frame) noexcept {
  if (entries_[frame].in_heap) return;
  entries_[frame].in_heap = true;
  entries_[frame].last_use = uses_[frame].load(std::memory_order_relaxed);
  std::uint32_t at = size_++;
  entries_[at].heap = frame;
  while (at > 0 && is_before(frame, entries_[(at - 1) / 2].heap)) {
    std::swap(entries_[at].heap, entries_[(at - 1) / 2].heap);
    at = (at - 1) / 2;
  }
}

void LruPolicy::pop() noexcept {
  entries_[entries_[0].heap].in_heap = false;
  entries_[0].heap = entries_[--size_].heap;
  sink();
}

void LruPolicy::sink() noexcept {
  for (std::uint32_t at = 0;;) {
    std::uint32_t first = at;
    for (std::uint32_t child = 2 * at + 1; child <= 2 * at + 2 && child < size_; ++child)
      if (is_before(entries_[child].heap, entries_[first].heap)) first = child;
    if (first == at) return;
    std::swap(entries_[at].heap, entries_[first].heap);
    at = first;
  }
}

// The loop ends because time does not advance during the call: each frame is corrected at most
// once.
std::uint32_t LruPolicy::choose_victim(const FrameStates& states) noexcept {
  while (size_ > 0) {
    const std::uint32_t frame = entries_[0].heap;
    const std::uint64_t use = uses_[frame].load(std::memory_order_relaxed);
    if (states.of(frame) != FrameStates::State::kEvictable) {
      pop();
    } else if (use > entries_[frame].last_use) {
      entries_[frame].last_use = use;
      sink();
    } else {
      return frame;
    }
  }
  return kNoFrame;
}

}  // namespace planetree::cache
