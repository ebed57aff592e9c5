#include "cache/policy/sieve_policy.h"

namespace planetree::cache {

std::uint32_t SievePolicy::choose_victim(const FrameStates& states) noexcept {
  // After one round no frame has a mark unless readers used it in the meantime. They could do so
  // without end, so marks are ignored in the second round.
  const std::uint64_t round_steps = queue_.size();
  for (std::uint64_t step = 0; step < 2 * round_steps; ++step) {
    const std::uint32_t frame = hand_ == kNoFrame ? queue_.oldest() : hand_;
    hand_ = frame;
    if (states.is_evictable(frame)) {
      const bool is_used = used_[frame].load(std::memory_order_relaxed) != 0;
      if (!is_used || step >= round_steps) return frame;
      used_[frame].store(0, std::memory_order_relaxed);
    }
    hand_ = queue_.newer(frame);
  }
  return kNoFrame;
}

}  // namespace planetree::cache
