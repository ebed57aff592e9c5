#include "cache/policy/recency_heap.h"

#include <utility>

namespace planetree::cache {

void RecencyHeap::use_now(std::uint32_t frame) noexcept {
  const std::uint64_t time = now_[0].load(std::memory_order_relaxed) + 1;
  now_[0].store(time, std::memory_order_relaxed);
  uses_[frame].store(time, std::memory_order_relaxed);
}

bool RecencyHeap::is_before(std::uint32_t frame, std::uint32_t other) const noexcept {
  const std::uint64_t last_use = entries_[frame].last_use, other_use = entries_[other].last_use;
  return last_use != other_use ? last_use < other_use : frame < other;
}

void RecencyHeap::add(std::uint32_t frame) noexcept {
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

void RecencyHeap::pop() noexcept {
  entries_[entries_[0].heap].in_heap = false;
  entries_[0].heap = entries_[--size_].heap;
  sink();
}

void RecencyHeap::sink() noexcept {
  for (std::uint32_t at = 0;;) {
    std::uint32_t first = at;
    for (std::uint32_t child = 2 * at + 1; child <= 2 * at + 2 && child < size_; ++child)
      if (is_before(entries_[child].heap, entries_[first].heap)) first = child;
    if (first == at) return;
    std::swap(entries_[at].heap, entries_[first].heap);
    at = first;
  }
}

}  // namespace planetree::cache
