#include "cache/policy/s3_fifo_policy.h"

#include <algorithm>

namespace planetree::cache {

S3FifoPolicy::S3FifoPolicy(const PolicyTables& tables) noexcept
    : uses_(tables.counts),
      nodes_(tables.nodes),
      small_(tables.nodes),
      main_(tables.nodes),
      small_capacity_(std::max(static_cast<std::uint32_t>(tables.nodes.size()) / kSmallShare,
                               std::uint32_t{1})),
      main_capacity_(static_cast<std::uint32_t>(tables.nodes.size()) - small_capacity_),
      ghosts_(tables.ghosts, main_capacity_) {}

void S3FifoPolicy::install(std::uint32_t frame, std::uint32_t page, PageTier /*tier*/) noexcept {
  uses_[frame].store(0, std::memory_order_relaxed);
  nodes_[frame].page = page;
  if (ghosts_.take(page)) {
    add_to_main(frame);
  } else {
    nodes_[frame].in_main = false;
    small_.add_newest(frame);
  }
}

void S3FifoPolicy::remove(std::uint32_t frame) noexcept {
  if (nodes_[frame].in_main) {
    main_.erase(frame);
  } else {
    small_.erase(frame);
    ghosts_.add(nodes_[frame].page);
  }
}

std::uint32_t S3FifoPolicy::choose_victim(const FrameStates& states) noexcept {
  if (small_.size() >= small_capacity_) {
    if (const std::uint32_t frame = victim_in_small(states); frame != kNoFrame) return frame;
    return victim_in_main(states);
  }
  if (const std::uint32_t frame = victim_in_main(states); frame != kNoFrame) return frame;
  // Only held or pinned pages are in the main queue. The small queue may move pages there.
  if (const std::uint32_t frame = victim_in_small(states); frame != kNoFrame) return frame;
  return victim_in_main(states);
}

// Frames that are not evictable keep their place.
std::uint32_t S3FifoPolicy::victim_in_small(const FrameStates& states) noexcept {
  for (std::uint32_t frame = small_.oldest(); frame != kNoFrame;) {
    const std::uint32_t next = small_.newer(frame);
    if (states.is_evictable(frame)) {
      if (uses_[frame].load(std::memory_order_relaxed) <= kUsesToStay) return frame;
      small_.erase(frame);
      uses_[frame].store(0, std::memory_order_relaxed);
      add_to_main(frame);
      if (main_.size() > main_capacity_) return victim_in_main(states);
    }
    frame = next;
  }
  return kNoFrame;
}

std::uint32_t S3FifoPolicy::victim_in_main(const FrameStates& states) noexcept {
  // After so many rounds no frame has uses left unless readers used it in the meantime. They could
  // do so without end, so uses are ignored afterwards.
  const std::uint64_t counted_steps = std::uint64_t{kMaxUses} * main_.size();
  const std::uint64_t max_steps = counted_steps + main_.size();
  for (std::uint64_t step = 0; step < max_steps; ++step) {
    const std::uint32_t frame = main_.oldest();
    if (states.is_evictable(frame)) {
      const std::uint8_t uses = uses_[frame].load(std::memory_order_relaxed);
      if (uses == 0 || step >= counted_steps) return frame;
      uses_[frame].store(static_cast<std::uint8_t>(uses - 1), std::memory_order_relaxed);
    }
    main_.erase(frame);
    main_.add_newest(frame);
  }
  return kNoFrame;
}

}  // namespace planetree::cache
