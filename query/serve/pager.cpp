#include "query/serve/pager.h"

#include <cstddef>
#include <utility>

#include "query/file/tree_header.h"

namespace planetree::query {

Result<std::unique_ptr<Pager>> Pager::create(storage::PageFile file, const Limits& limits) {
  if (const auto checked = check_tree_header(file.header()); !checked) return checked.error();
  std::unique_ptr<Pager> pager(new Pager(std::move(file), limits.opened));
  if (const auto claimed = pager->claim(limits); !claimed) return claimed.error();
  if (const auto pinned = pager->cache_->pin(0); !pinned)
    return pager->read_error().value_or(pinned.error());
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
  cache_limits.reserved_bytes = file.memory_bytes() +
                                PageFiller::bytes(filler_limits(header, limits)) + sizeof(Pager) +
                                QueryArena::bytes(limits.arena) +
                                limits.probe_bytes * limits.max_probes + limits.thread_bytes;
  return cache_limits;
}

std::uint64_t Pager::min_budget_bytes(const storage::PageFile& file,
                                      const Limits& limits) noexcept {
  return cache::minimum_budget_bytes(cache_limits(file, limits));
}

Result<void> Pager::claim(const Limits& limits) {
  const auto fill = [](void* context, const cache::FillRequest& request) {
    auto& pager = *static_cast<Pager*>(context);
    return pager.filler_.fill(pager.file_, request.page, request);
  };
  auto cache = cache::PageCache::create(cache_limits(file_, limits), fill, this);
  if (!cache) return cache.error();
  cache_ = std::move(*cache);
  auto arena = QueryArena::claim(limits.arena);
  if (!arena) return arena.error();
  query_arena_.emplace(*std::move(arena));
  start_traces(limits.trace_time);
  if (const auto locked = lock(limits.locking); !locked) return locked;
  return filler_.claim(filler_limits(file_.header(), limits));
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

PageFiller::Limits Pager::filler_limits(const storage::FileHeader& header,
                                        const Limits& limits) noexcept {
  return {fetcher_count(limits), header.max_raw_bytes, header.max_stored_bytes,
          header.page_bytes,     limits.wait_limit,    limits.use_io_uring};
}

}  // namespace planetree::query
