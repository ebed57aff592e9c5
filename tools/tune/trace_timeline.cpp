#include "tools/tune/trace_timeline.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace planetree::tools {

void PageSet::merge(const PageSet& other) {
  words_.resize(std::max(words_.size(), other.words_.size()), 0);
  for (std::size_t i = 0; i < other.words_.size(); ++i) words_[i] |= other.words_[i];
}

std::size_t PageSet::size() const {
  std::size_t size = 0;
  for (const std::uint64_t word : words_) size += static_cast<std::size_t>(std::popcount(word));
  return size;
}

TraceTimeline::Window& TraceTimeline::window_at(std::uint64_t time_ns) {
  while (time_ns / window_ns_ >= kMaxWindows) {
    for (std::size_t i = 0; i < windows_.size(); ++i) {
      if (i % 2 == 0) {
        if (i > 0) windows_[i / 2] = std::move(windows_[i]);
        continue;
      }
      Window& joined = windows_[i / 2];
      joined.looked_up.merge(windows_[i].looked_up);
      joined.resident.merge(windows_[i].resident);
      joined.lookups += windows_[i].lookups;
      joined.misses += windows_[i].misses;
      joined.degraded += windows_[i].degraded;
    }
    windows_.resize((windows_.size() + 1) / 2);
    window_ns_ *= 2;
  }
  const std::size_t index = time_ns / window_ns_;
  while (windows_.size() <= index) {
    windows_.emplace_back();
    windows_.back().resident = resident_;
  }
  return windows_[index];
}

void TraceTimeline::add(const PageAccess& access) {
  using Event = PageAccess::Event;
  Window& window = window_at(access.time_ns);
  if (access.event == Event::kMotion) return;
  if (access.event == Event::kDegraded) {
    ++window.degraded;
    return;
  }
  if (!ordered_.contains(access.page)) {
    ordered_.insert(access.page);
    order_[{static_cast<std::uint64_t>(access.section), access.octcode}].push_back(access.page);
  }
  switch (access.event) {
    case Event::kInstalled:
      resident_.insert(access.page);
      window.resident.insert(access.page);
      return;
    case Event::kEvicted:
    case Event::kEvictedUnused:
      resident_.erase(access.page);
      return;
    default:
      break;
  }
  if (access.query_kind != PageAccess::Query::kClosestPoint &&
      access.query_kind != PageAccess::Query::kContains)
    return;
  ++window.lookups;
  window.looked_up.insert(access.page);
  window.misses +=
      access.event == Event::kFetched ||
      ((access.event == Event::kMissed || access.event == Event::kLate) && access.needed);
}

std::size_t TraceTimeline::rows(std::size_t most) const { return std::min(most, ordered_.size()); }

std::vector<float> TraceTimeline::shares(PageSet Window::*set, std::size_t most) const {
  const std::size_t row_count = rows(most), pages = ordered_.size();
  std::vector<float> shares(row_count * windows_.size(), 0);
  std::vector<std::size_t> sizes(row_count, 0);
  const auto row_of = [&](std::size_t rank) { return rank * row_count / pages; };
  for (std::size_t rank = 0; rank < pages; ++rank) ++sizes[row_of(rank)];
  std::size_t rank = 0;
  for (const auto& [key, numbers] : order_)
    for (const std::uint32_t page : numbers) {
      const std::size_t row = row_of(rank++);
      for (std::size_t i = 0; i < windows_.size(); ++i)
        if ((windows_[i].*set).contains(page))
          shares[row * windows_.size() + i] += 1.0F / static_cast<float>(sizes[row]);
    }
  return shares;
}

}  // namespace planetree::tools
