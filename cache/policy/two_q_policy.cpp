#include "cache/policy/two_q_policy.h"

#include <algorithm>

namespace planetree::cache {
namespace {

std::uint32_t share_of(std::span<const FrameNode> nodes, std::uint32_t share) noexcept {
  return std::max(static_cast<std::uint32_t>(nodes.size()) / share, std::uint32_t{1});
}

}  // namespace

TwoQPolicy::TwoQPolicy(const PolicyTables& tables) noexcept
    : nodes_(tables.nodes),
      queue_(tables.nodes),
      main_(tables.now, tables.uses, tables.entries),
      queue_capacity_(share_of(tables.nodes, kQueueShare)),
      ghosts_(tables.ghosts, share_of(tables.nodes, kGhostShare)) {}

void TwoQPolicy::install(std::uint32_t frame, std::uint32_t page, PageTier /*tier*/) noexcept {
  main_.use_now(frame);
  nodes_[frame].page = page;
  nodes_[frame].in_main = ghosts_.take(page);
  if (nodes_[frame].in_main) {
    main_.add(frame);
  } else {
    queue_.add_newest(frame);
  }
}

void TwoQPolicy::remove(std::uint32_t frame) noexcept {
  if (nodes_[frame].in_main) {
    // It leaves the heap when it is at the top, unless it is a main page again by then.
    nodes_[frame].in_main = false;
  } else {
    queue_.erase(frame);
    ghosts_.add(nodes_[frame].page);
  }
}

std::uint32_t TwoQPolicy::choose_victim(const FrameStates& states) noexcept {
  if (queue_.size() > queue_capacity_) {
    const std::uint32_t frame = victim_in_queue(states);
    return frame != kNoFrame ? frame : victim_in_main(states);
  }
  const std::uint32_t frame = victim_in_main(states);
  return frame != kNoFrame ? frame : victim_in_queue(states);
}

std::uint32_t TwoQPolicy::victim_in_queue(const FrameStates& states) const noexcept {
  std::uint32_t frame = queue_.oldest();
  while (frame != kNoFrame && !states.is_evictable(frame)) frame = queue_.newer(frame);
  return frame;
}

std::uint32_t TwoQPolicy::victim_in_main(const FrameStates& states) noexcept {
  return main_.least_recent([this, &states](std::uint32_t frame) {
    return nodes_[frame].in_main && states.is_evictable(frame);
  });
}

}  // namespace planetree::cache
