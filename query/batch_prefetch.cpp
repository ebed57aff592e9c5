#include "query/batch_prefetch.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <cstdint>

#include "query/file/pages_below.h"
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
    if ((stop_ && stop_->load(std::memory_order_relaxed)) || !run_round(first, end)) return;
}

// Returns how many pages the queries lack, each counted once, and which, as far as there is room.
std::size_t BatchPrefetch::find_missing(std::size_t first, std::size_t end,
                                        std::span<std::uint32_t> pages) noexcept {
  std::size_t count = 0;
  const auto add_missing = [&](const Vec3& query, const QueryOptions& options) {
    std::array<std::uint32_t, kMaxPagesEach> lacking;
    const std::size_t found =
        probe_.missing_pages(query, options, std::span(lacking).first(pages_each_));
    for (const std::uint32_t page : std::span(lacking).first(found)) {
      const auto known = pages.first(count);
      if (count < pages.size() && std::find(known.begin(), known.end(), page) == known.end())
        pages[count++] = page;
    }
  };
  // The side is searched in other pages than the distance, which need not be known for that.
  QueryOptions of_side = options_;
  of_side.parts = kSide;
  const bool has_both = (options_.parts & kSide) != 0 && options_.parts != kSide;
  for (std::size_t i = first; i < end && count < pages.size(); ++i) {
    const Vec3& query = queries_[order_.query(i)];
    add_missing(query, options_);
    if (has_both) add_missing(query, of_side);
  }
  return count;
}

// Loads pages until one did not come in time. Returns whether any is resident now.
bool BatchPrefetch::load(std::span<const std::uint32_t> pages) noexcept {
  bool has_read = false;
  for (const std::uint32_t page : pages) {
    const ProbeState::Loaded loaded = probe_.load_page(page);
    if (loaded == ProbeState::Loaded::kResident) ++loaded_pages_;
    has_read = has_read || loaded == ProbeState::Loaded::kResident;
    is_late_ = loaded == ProbeState::Loaded::kLate;
    if (is_late_) return false;
  }
  return has_read;
}

// Returns the pages that the queries lack and that take a request. Pages that take none are loaded
// first, because they may lead to others.
std::span<std::uint32_t> BatchPrefetch::find_beyond(std::size_t first, std::size_t end,
                                                    std::span<std::uint32_t> room) noexcept {
  std::span<std::uint32_t> pages;
  for (unsigned look = 0; look < kMaxLooks; ++look) {
    pages = room.first(find_missing(first, end, room));
    const auto beyond = std::partition(pages.begin(), pages.end(), [this](std::uint32_t page) {
      return probe_.model().remote_file->is_here(page);
    });
    const auto here = static_cast<std::size_t>(beyond - pages.begin());
    if (here == 0 || !load(pages.first(here))) break;
  }
  return is_late_ ? std::span<std::uint32_t>() : pages;
}

// Asks the server for pages and, of few queries, for pages that they lead to.
void BatchPrefetch::request(std::span<const std::uint32_t> pages) const noexcept {
  const storage::PageFile& file = *probe_.model().remote_file;
  std::array<std::uint32_t, kMaxPages> wanted;
  std::copy(pages.begin(), pages.end(), wanted.begin());
  std::size_t count = pages.size();
  for (std::size_t i = 0; pages_each_ > 1 && i < pages.size(); ++i)
    count += find_pages_below(file, pages[i], std::span(wanted).subspan(count));
  file.prefetch_within(std::span(wanted).first(count), probe_.wait_left());
}

// Returns false if no query lacks a page that can be got.
bool BatchPrefetch::run_round(std::size_t first, std::size_t end) noexcept {
  const cache::PageCache& cache = probe_.model().cache;
  const std::size_t max_pages = cache.holds_all_pages()
                                    ? kMaxPages
                                    : std::min<std::size_t>(kMaxPages, cache.frame_count() / 4);
  std::array<std::uint32_t, kMaxPages> missing;
  const std::span<std::uint32_t> pages =
      find_beyond(first, end, std::span(missing).first(max_pages));
  if (pages.empty()) return false;
  std::sort(pages.begin(), pages.end());
  request(pages);
  return load(pages);
}

// Gets pages of a query of a fetch thread, many at once. Returns how many.
[[gnu::noinline]] std::uint32_t ProbeState::fetch_ahead(const Vec3& query,
                                                        const QueryOptions& options,
                                                        FetchReason reason,
                                                        std::span<const Vec3> ahead,
                                                        const std::atomic<bool>& stop) noexcept {
  assert(ahead.size() <= MotionPrefetch::kPositions);
  std::array<Vec3, 1 + MotionPrefetch::kPositions> positions{query};
  std::copy(ahead.begin(), ahead.end(), positions.begin() + 1);
  const auto queries = std::span(positions).first(1 + ahead.size());
  const BatchOrder order;
  QueryOptions wanted = options;
  // The side of a probe that moves along the surface takes no pages of the mask.
  if (reason == FetchReason::kMotion && wanted.parts != kSide) wanted.parts &= ~kSide;
  // The probe will not be exactly there, so the pages around are got too.
  const std::size_t pages_each =
      ahead.empty() ? BatchPrefetch::pages_each(1) : BatchPrefetch::kMaxPagesEach;
  BatchPrefetch prefetch(*this, queries, order, wanted, pages_each, &stop);
  prefetch.run_rounds(0, queries.size());
  return prefetch.loaded_pages();
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
  BatchPrefetch prefetch(*this, {&query, 1}, order, options, BatchPrefetch::pages_each(1));
  prefetch.run_rounds(0, 1);
  return !prefetch.is_late();
}

}  // namespace planetree::query
