#include "query/batch_prefetch.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>

#include "query/probe_state.h"

namespace planetree::query {

bool BatchPrefetch::helps(const ProbeState& probe, const QueryOptions& options) noexcept {
  return probe.model().remote_file && options.wait == Wait::kForPages;
}

void BatchPrefetch::run(std::size_t first, std::size_t end) noexcept {
  if (is_late_) return;
  const ProbeState::WaitLimit limit(probe_);
  run_rounds(first, end);
}

void BatchPrefetch::run_rounds(std::size_t first, std::size_t end) noexcept {
  for (unsigned round = 0; round < kMaxRounds && !is_late_; ++round)
    if (!run_round(first, end)) return;
}

// Returns how many pages the queries lack, each counted once, and which, as far as there is room.
std::size_t BatchPrefetch::find_missing(std::size_t first, std::size_t end,
                                        std::span<std::uint32_t> pages) noexcept {
  std::size_t count = 0;
  const auto add = [&](std::uint32_t page) {
    const auto known = pages.first(count);
    if (page == PageAccessor::kNoPage || count == pages.size() ||
        std::find(known.begin(), known.end(), page) != known.end())
      return;
    pages[count++] = page;
  };
  // The side is searched in other pages than the distance, which need not be known for that.
  QueryOptions of_side = options_;
  of_side.parts = kSide;
  const bool has_both = (options_.parts & kSide) != 0 && options_.parts != kSide;
  for (std::size_t i = first; i < end && count < pages.size(); ++i) {
    const Vec3& query = queries_[order_.query(i)];
    add(probe_.first_missing_page(query, options_));
    if (has_both) add(probe_.first_missing_page(query, of_side));
  }
  return count;
}

// Returns false if no query lacks a page that can be got.
bool BatchPrefetch::run_round(std::size_t first, std::size_t end) noexcept {
  const cache::PageCache& cache = probe_.model().cache;
  const std::size_t max_pages = cache.holds_all_pages()
                                    ? kMaxPages
                                    : std::min<std::size_t>(kMaxPages, cache.frame_count() / 4);
  std::array<std::uint32_t, kMaxPages> missing;
  const std::size_t count = find_missing(first, end, std::span(missing).first(max_pages));
  if (count == 0) return false;
  const std::span<std::uint32_t> pages(missing.data(), count);
  std::sort(pages.begin(), pages.end());
  probe_.model().remote_file->prefetch_within(pages, probe_.wait_left());
  bool has_read = false;
  for (const std::uint32_t page : pages) {
    const ProbeState::Loaded loaded = probe_.load_page(page);
    has_read = has_read || loaded == ProbeState::Loaded::kResident;
    is_late_ = loaded == ProbeState::Loaded::kLate;
    if (is_late_) return false;
  }
  return has_read;
}

// Returns the terms of a query that waits, for a remote model.
[[gnu::noinline]] cache::FetchTerms ProbeState::remote_terms() const noexcept {
  cache::FetchTerms terms = model_.query_terms;
  terms.deadline = std::min(deadline_, std::chrono::steady_clock::now() + terms.wait_limit);
  return terms;
}

std::chrono::milliseconds ProbeState::wait_left() const noexcept {
  return std::chrono::ceil<std::chrono::milliseconds>(deadline_ - std::chrono::steady_clock::now());
}

// Returns false if a page did not come in time. Needs a WaitLimit. Not inlined, because files of
// this machine need nothing of it.
[[gnu::noinline]] bool ProbeState::look_ahead(const Vec3& query,
                                              const QueryOptions& options) noexcept {
  const BatchOrder order;
  BatchPrefetch prefetch(*this, {&query, 1}, order, options);
  prefetch.run_rounds(0, 1);
  return !prefetch.is_late();
}

}  // namespace planetree::query
