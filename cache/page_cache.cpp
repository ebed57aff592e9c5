#include "cache/page_cache.h"

#include <algorithm>
#include <cassert>
#include <cinttypes>
#include <new>
#include <utility>

namespace planetree::cache {

Result<std::unique_ptr<PageCache>> PageCache::create(const CacheLimits& limits, FillPage fill,
                                                     void* context) noexcept {
  assert(fill != nullptr);
  if (Result<void> checked = check_limits(limits); !checked) return checked.error();
  const std::uint32_t frame_count = frames_within_budget(limits);
  if (frame_count < minimum_frame_count(limits)) {
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "a memory budget of %" PRIu64 " bytes is too small: give at least %" PRIu64
                      " bytes, or lower max_probes",
                      limits.budget_bytes, minimum_budget_bytes(limits));
  }
  Result<PrefaultedMemory> memory = PrefaultedMemory::claim(tables_bytes(limits, frame_count));
  if (!memory) return memory.error();
  std::optional<PrefaultedMemory> page_memory;
  if (limits.is_shared) {
    auto reserved = PrefaultedMemory::reserve(page_tables_bytes(limits, limits.page_count));
    if (!reserved) return reserved.error();
    page_memory.emplace(*std::move(reserved));
  }
  Result<FramePool> frames = FramePool::create(frame_count, limits.frame_bytes);
  if (!frames) return frames.error();
  std::unique_ptr<PageCache> cache(new (std::nothrow) PageCache(
      limits, fill, context, *std::move(memory), std::move(page_memory), *std::move(frames)));
  if (cache == nullptr) {
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory for the page cache: free memory");
  }
  assert(bytes_needed(limits, frame_count) <= limits.budget_bytes);
  return cache;
}

PageCache::PageCache(const CacheLimits& limits, FillPage fill, void* context,
                     PrefaultedMemory memory, std::optional<PrefaultedMemory> page_memory,
                     FramePool frames) noexcept
    : limits_(limits),
      fill_(fill),
      context_(context),
      table_memory_(std::move(memory)),
      page_memory_(std::move(page_memory)),
      frames_(std::move(frames)),
      tables_(make_tables(limits, frames_.frame_count(), table_memory_,
                          page_memory_ ? &*page_memory_ : nullptr)),
      map_(tables_.map),
      evictor_(limits.policy, tables_.policy),
      limbo_(tables_.slots, tables_.entries, tables_.stamps),
      in_flight_reads_(tables_.in_flight_reads),
      free_count_(frames_.frame_count()),
      files_(limits.page_count) {
  // The stack has frame 0 on top, so that frames are used in order.
  for (std::uint32_t i = 0; i < free_count_; ++i) tables_.free_frames[i] = free_count_ - 1 - i;
}

PageCache::~PageCache() {
  assert(std::none_of(tables_.slots.begin(), tables_.slots.end(),
                      [](const ReaderSlot& slot) { return slot.claimed(); }));
}

Result<Reader> PageCache::claim_reader() noexcept {
  for (ReaderSlot& slot : tables_.slots) {
    if (slot.try_claim())
      return Reader(*this, slot, static_cast<std::uint32_t>(&slot - tables_.slots.data()));
  }
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "the limit of %u probes is reached: open the model with a larger max_probes",
                    limits_.max_readers - limits_.own_readers);
}

Result<void> PageCache::pin(std::uint32_t page) noexcept {
  assert(page < limits_.page_count);
  Error why = make_error(ErrorCode::kDamaged, page, Error::kNowhere,
                         "page %u was found unreadable before: rebuild the file", page);
  Lock lock(mutex_);
  const Outcome outcome = make_resident(lock, pin_fetcher(), page, {}, &why);
  if (outcome != Outcome::kResident) return why;
  return pin_resident(page);
}

Result<void> PageCache::pin_resident(std::uint32_t page) noexcept {
  const std::uint32_t frame = map_.frame_of(page);
  if (evictor_.state(frame) == Evictor::State::kPinned) return {};
  const std::uint32_t frame_count = frames_.frame_count();
  const std::uint32_t entries = limits_.max_readers + 1;
  // page_fetch.cpp explains why max_readers + 1 frames must stay unpinned. A shared cache keeps a
  // frame for one pinned page of each file.
  if (!limits_.is_shared && frame_count < limits_.used_pages() &&
      frame_count - pinned_count_ <= entries) {
    return make_error(ErrorCode::kNoMemory, page, Error::kNowhere,
                      "pinning more than %u of %u frames leaves too few for queries: "
                      "raise the memory budget",
                      pinned_count_, frame_count);
  }
  evictor_.pin(frame);
  ++pinned_count_;
  return {};
}

bool PageCache::quarantined(std::uint32_t page) const noexcept {
  return (tables_.quarantine_bits[page / 64] >> page % 64 & 1) != 0;
}

void PageCache::quarantine(std::uint32_t page) noexcept {
  tables_.quarantine_bits[page / 64] |= std::uint64_t{1} << page % 64;
  add_one(counts_.quarantined);
}

bool PageCache::lock_memory() noexcept {
  const bool tables = table_memory_.lock(), arena = frames_.lock();
  locked_bytes_ = (tables ? table_memory_.bytes() : 0) + (arena ? frames_.arena_bytes() : 0);
  return tables && arena;
}

CacheStats PageCache::stats() const noexcept {
  CacheStats stats{};
  for (const ReaderSlot& slot : tables_.slots) {
    stats.hits += slot.hits();
    stats.misses += slot.misses();
  }
  stats.fills = counts_.fills.load(std::memory_order_relaxed);
  stats.evictions = counts_.evictions.load(std::memory_order_relaxed);
  stats.quarantined = counts_.quarantined.load(std::memory_order_relaxed);
  stats.given_up = counts_.given_up.load(std::memory_order_relaxed);
  stats.frame_count = frame_count();
  stats.arena_bytes = frames_.arena_bytes() -
                      discarded_count_.load(std::memory_order_relaxed) * frames_.stride_bytes();
  stats.table_bytes = table_memory_.bytes();
  stats.reserved_bytes = limits_.reserved_bytes;
  stats.budget_bytes = limits_.budget_bytes;
  stats.locked_bytes = locked_bytes_;
  return stats;
}

Reader::Reader(PageCache& cache, ReaderSlot& slot, std::uint32_t index,
               std::uint32_t first_page) noexcept
    : map_(cache.map_.from(first_page)),
      reference_bits_(cache.evictor_.reference_bits()),
      frames_(cache.frames_.frame(0)),
      stride_bytes_(cache.frames_.stride_bytes()),
      slot_(&slot),
      index_(index),
      first_page_(first_page),
      cache_(&cache) {}

Reader::Reader(Reader&& other) noexcept
    : map_(other.map_),
      reference_bits_(other.reference_bits_),
      frames_(other.frames_),
      stride_bytes_(other.stride_bytes_),
      slot_(std::exchange(other.slot_, nullptr)),
      index_(other.index_),
      first_page_(other.first_page_),
      owns_slot_(other.owns_slot_),
      cache_(other.cache_) {}

Reader& Reader::operator=(Reader&& other) noexcept {
  if (this == &other) return *this;
  give_back();
  map_ = other.map_;
  reference_bits_ = other.reference_bits_;
  frames_ = other.frames_;
  stride_bytes_ = other.stride_bytes_;
  slot_ = std::exchange(other.slot_, nullptr);
  index_ = other.index_;
  first_page_ = other.first_page_;
  owns_slot_ = other.owns_slot_;
  cache_ = other.cache_;
  return *this;
}

Reader::~Reader() { give_back(); }

void Reader::give_back() noexcept {
  if (slot_ == nullptr || !owns_slot_) return;
  if (slot_->inside()) slot_->leave();
  std::exchange(slot_, nullptr)->release();
}

}  // namespace planetree::cache
