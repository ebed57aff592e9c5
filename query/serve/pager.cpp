#include "query/serve/pager.h"

#include <algorithm>
#include <cstddef>
#include <new>
#include <utility>

#include "query/file/page_decoding.h"
#include "query/file/tree_header.h"

namespace planetree::query {
namespace {

bool stored_fits_frame(const storage::FileHeader& header) {
  return header.max_stored_bytes <= header.page_bytes;
}

// Bytes that each fetcher needs to unpack a page.
std::uint64_t scratch_bytes(const storage::FileHeader& header) {
  return header.max_raw_bytes + (stored_fits_frame(header) ? 0 : header.max_stored_bytes);
}

}  // namespace

Result<std::unique_ptr<Pager>> Pager::create(storage::PageFile file, const Limits& limits) {
  if (const auto checked = check_tree_header(file.header()); !checked) return checked.error();
  std::unique_ptr<Pager> pager(new Pager(std::move(file), limits.opened));
  if (const auto claimed = pager->claim(limits); !claimed) return claimed.error();
  if (const auto pinned = pager->cache_->pin(0); !pinned) return pinned.error();
  return pager;
}

cache::CacheLimits Pager::cache_limits(const storage::PageFile& file,
                                       const Limits& limits) noexcept {
  const storage::FileHeader& header = file.header();
  cache::CacheLimits cache_limits{};
  cache_limits.budget_bytes = limits.budget_bytes;
  cache_limits.page_count = limits.opened.page_count(header);
  cache_limits.unused_pages = limits.opened.unused_pages(header);
  cache_limits.frame_bytes = header.page_bytes;
  cache_limits.policy = limits.policy;
  cache_limits.max_readers = limits.readers();
  cache_limits.own_readers = limits.thread_probes;
  const std::uint64_t wait_bytes = fetcher_count(limits) * sizeof(FetcherWait) +
                                   max_read_waits(limits) * storage::ReadWait::kMappedBytes;
  cache_limits.reserved_bytes = file.table_memory_bytes() +
                                fetcher_count(limits) * scratch_bytes(header) + wait_bytes +
                                sizeof(Pager) + QueryArena::bytes(limits.arena) +
                                limits.probe_bytes * limits.max_probes + limits.thread_bytes;
  return cache_limits;
}

std::uint64_t Pager::min_budget_bytes(const storage::PageFile& file,
                                      const Limits& limits) noexcept {
  return cache::minimum_budget_bytes(cache_limits(file, limits));
}

Result<void> Pager::claim(const Limits& limits) {
  max_wait_ = std::min(limits.wait_limit, kMaxReadWait);
  max_read_waits_ = max_read_waits(limits);
  const auto fill = [](void* context, const cache::FillRequest& request) {
    return static_cast<Pager*>(context)->fill(request);
  };
  auto cache = cache::PageCache::create(cache_limits(file_, limits), fill, this);
  if (!cache) return cache.error();
  cache_ = std::move(*cache);
  auto arena = QueryArena::claim(limits.arena);
  if (!arena) return arena.error();
  query_arena_.emplace(*std::move(arena));
  start_traces(limits.trace_time);
  if (const auto locked = lock(limits.locking); !locked) return locked;
  const std::uint64_t fetchers = fetcher_count(limits);
  scratch_.reset(new (std::nothrow) std::byte[fetchers * scratch_bytes(file_.header())]);
  fetcher_waits_.reset(new (std::nothrow) FetcherWait[fetchers]);
  if (!scratch_ || !fetcher_waits_)
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory to read pages; free some and try again");
  return {};
}

void Pager::start_traces(TimeSource time) noexcept {
  PageTraces* const traces = query_arena_->parts().traces;
  if (!traces) return;
  traces->clock.start(time);
  cache_->set_observer(
      {traces,
       [](void* context, std::uint32_t fetcher, std::uint32_t page, cache::PageTier tier) noexcept {
         static_cast<PageTraces*>(context)->of_fetcher(fetcher).installed(
             page, tier == cache::PageTier::kUpper);
       },
       [](void* context, std::uint32_t fetcher, std::uint32_t page) noexcept {
         static_cast<PageTraces*>(context)->of_fetcher(fetcher).evicted(page);
       }});
}

Result<void> Pager::lock(Locking locking) noexcept {
  if (locking == Locking::kNever) return {};
  // Locks the smaller part first, since the limit of the system may allow no more.
  query_arena_is_locked_ = query_arena_->lock();
  const bool cache_is_locked = cache_->lock_memory();
  if ((query_arena_is_locked_ && cache_is_locked) || locking != Locking::kRequire) return {};
  return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                    "the system does not let memory be locked; raise the limit (ulimit -l), "
                    "lower the memory budget, or open the model without locking");
}

Result<cache::FillResult> Pager::fill(const cache::FillRequest& request) noexcept {
  const storage::FileHeader& header = file_.header();
  const storage::PageEntry& entry = file_.entries()[request.page];
  std::byte* const scratch = scratch_.get() + request.fetcher * scratch_bytes(header);
  const std::span<std::byte> raw(scratch, entry.raw_bytes);
  // The frame is written last. Until then it may hold the stored bytes.
  const std::span<std::byte> stored =
      stored_fits_frame(header)
          ? request.frame
          : std::span(scratch + header.max_raw_bytes, header.max_stored_bytes);
  if (request.may_block) {
    if (const auto read = file_.read_page(request.page, stored, raw); !read) return read.error();
  } else {
    const auto read = file_.try_read_page(request.page, stored, raw, read_limits(request));
    if (!read) return read.error();
    if (!*read) return cache::FillResult::kWouldBlock;
  }
  if (const auto decoded = decode_frame(header, entry, request.page, raw, request.frame); !decoded)
    return decoded.error();
  return leads_to_pages(header, request.page, request.frame) ? cache::FillResult::kFilledUpper
                                                             : cache::FillResult::kFilled;
}

storage::ReadLimits Pager::read_limits(const cache::FillRequest& request) noexcept {
  storage::ReadLimits limits;
  if (max_wait_.count() > 0) limits.wait = read_wait_for(request.fetcher);
  limits.max_wait = max_wait_;
  limits.prefetch_for_write = request.frame;
  return limits;
}

storage::ReadWait* Pager::read_wait_for(std::uint32_t fetcher) noexcept {
  FetcherWait& fetcher_wait = fetcher_waits_[fetcher];
  if (!fetcher_wait.is_granted && granted_waits_.load(std::memory_order_relaxed) < max_read_waits_)
    fetcher_wait.is_granted =
        granted_waits_.fetch_add(1, std::memory_order_relaxed) < max_read_waits_;
  return fetcher_wait.is_granted ? &fetcher_wait.wait : nullptr;
}

}  // namespace planetree::query
