#include "query/batch_prefetch.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "query/probe_state.h"

namespace planetree::query {

bool BatchPrefetch::helps(const ProbeState& probe, const QueryOptions& options) noexcept {
  return probe.model().remote_file && options.wait == Wait::kForPages;
}

void BatchPrefetch::run(std::size_t first, std::size_t end) noexcept {
  for (unsigned round = 0; round < kMaxRounds && !has_failed_; ++round)
    if (!run_round(first, end)) return;
}

// Returns false if no query lacks a page that can be got.
bool BatchPrefetch::run_round(std::size_t first, std::size_t end) noexcept {
  const std::size_t max_pages = std::min<std::size_t>(
      kMaxPages,
      probe_.model().cache.holds_all_pages() ? kMaxPages : probe_.model().cache.frame_count() / 4);
  std::array<std::uint32_t, kMaxPages> missing;
  std::size_t count = 0;
  for (std::size_t i = first; i < end && count < max_pages; ++i) {
    const std::uint32_t page = probe_.first_missing_page(queries_[order_.query(i)], options_);
    const auto known = missing.begin() + static_cast<std::ptrdiff_t>(count);
    if (page != PageAccessor::kNoPage && std::find(missing.begin(), known, page) == known)
      missing[count++] = page;
  }
  if (count == 0) return false;
  const std::span<std::uint32_t> pages(missing.data(), count);
  std::sort(pages.begin(), pages.end());
  probe_.model().remote_file->prefetch(pages);
  for (const std::uint32_t page : pages) has_failed_ = has_failed_ || !probe_.load_page(page);
  return !has_failed_;
}

}  // namespace planetree::query
