#include "cache/page_cache.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cinttypes>
#include <new>
#include <thread>
#include <utility>

namespace planetree::cache {
namespace {

void add_one(std::atomic<std::uint64_t>& count) noexcept {
  count.fetch_add(1, std::memory_order_relaxed);
}

/// Lets others run while a frame is in limbo. Sections last microseconds, so
/// first only yield; but yielding does not let a thread of lower priority run,
/// and the section waited for may be that thread's: so sleep if it lasts.
void wait_for_sections(std::uint32_t attempt) noexcept {
  constexpr std::uint32_t kYields = 64;
  if (attempt < kYields) {
    std::this_thread::yield();
  } else {
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

}  // namespace

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
  Result<ClaimedMemory> memory = ClaimedMemory::claim(tables_bytes(limits, frame_count));
  if (!memory) return memory.error();
  Result<FramePool> frames = FramePool::create(frame_count, limits.frame_bytes);
  if (!frames) return frames.error();
  std::unique_ptr<PageCache> cache(
      new (std::nothrow) PageCache(limits, fill, context, *std::move(memory), *std::move(frames)));
  if (cache == nullptr) {
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory for the page cache: free memory");
  }
  assert(bytes_needed(limits, frame_count) <= limits.budget_bytes);
  return cache;
}

PageCache::PageCache(const CacheLimits& limits, FillPage fill, void* context, ClaimedMemory memory,
                     FramePool frames) noexcept
    : limits_(limits),
      fill_(fill),
      context_(context),
      table_memory_(std::move(memory)),
      frames_(std::move(frames)),
      tables_(make_tables(limits, frames_.frame_count(), table_memory_)),
      map_(tables_.map),
      clock_(tables_.scores, tables_.states),
      limbo_(tables_.slots, tables_.places, tables_.stamps),
      free_count_(frames_.frame_count()) {
  // A stack with frame 0 on top, so that frames are used in order.
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
                    "all %u probes are in use: open the model with a larger max_probes",
                    limits_.max_readers);
}

// Why fetch() ends. A thread waits here outside any section and without the
// mutex, so it holds up nobody. What it waits for is its own frame in limbo,
// which no other thread may take and which waits only for the sections that
// were open when it was retired: not for later ones, and those open do not
// depend on us. So if every section ends and the mutex lets everybody in, each
// fetch ends, however the others go on.
//
// And it always gets a frame into limbo at once. When there are fewer frames
// than pages, pin() leaves at least max_readers + 1 unpinned ones. The other
// owners, max_readers of them, hold one each at most. So one is left, which is
// free or resident and can be evicted. When there is a frame for each page,
// an absent page means a free frame.
const std::byte* PageCache::fetch(ReaderSlot& slot, std::uint32_t page) noexcept {
  assert(page < limits_.page_count);
  const auto owner = static_cast<std::uint32_t>(&slot - tables_.slots.data());
  for (std::uint32_t attempt = 0;; ++attempt) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      const Attempt outcome = try_make_resident(owner, page, nullptr);
      if (outcome != Attempt::kNoFrameYet) {
        // Entering before the mutex is free: whoever evicts this page later
        // has the mutex after us, sees us inside, and leaves its frame alone.
        slot.enter();
        if (outcome == Attempt::kUnreadable) return nullptr;
        return frames_.frame(map_.frame_of(page));
      }
    }
    wait_for_sections(attempt);
  }
}

PageCache::Attempt PageCache::try_make_resident(std::uint32_t owner, std::uint32_t page,
                                                Error* why) noexcept {
  limbo_.set_awaited(owner, false);
  // Another thread may have brought the page while this one waited.
  if (const std::uint32_t frame = map_.frame_of(page); frame != kNoFrame) {
    ClockPolicy::mark(clock_.scores()[frame]);
    return Attempt::kResident;
  }
  if (quarantined(page)) return Attempt::kUnreadable;
  const std::uint32_t frame = take_frame(owner);
  if (frame == kNoFrame) {
    limbo_.set_awaited(owner, true);
    return Attempt::kNoFrameYet;
  }
  const Result<void> filled =
      fill_(context_, page, std::span<std::byte>(frames_.frame(frame), limits_.frame_bytes));
  if (!filled) {
    tables_.free_frames[free_count_++] = frame;
    quarantine(page);
    if (why != nullptr) *why = filled.error();
    return Attempt::kUnreadable;
  }
  tables_.pages[frame] = page;
  clock_.install(frame);
  map_.publish(page, frame);
  add_one(counts_.fills);
  return Attempt::kResident;
}

std::uint32_t PageCache::take_frame(std::uint32_t owner) noexcept {
  if (free_count_ > 0) return tables_.free_frames[--free_count_];
  if (const std::uint32_t frame = limbo_.take(owner); frame != kNoFrame) return frame;
  if (const std::uint32_t frame = limbo_.take_unawaited(); frame != kNoFrame) return frame;
  if (limbo_.holds(owner)) return kNoFrame;
  evict_into_limbo(owner);
  // At once, if no section was open.
  return limbo_.take(owner);
}

void PageCache::evict_into_limbo(std::uint32_t owner) noexcept {
  const std::uint32_t frame = clock_.choose_victim();
  assert(frame != kNoFrame);
  if (frame == kNoFrame) return;
  clock_.remove(frame);
  // Withdrawing comes before noting the open sections: E2, then E3.
  map_.withdraw(tables_.pages[frame]);
  limbo_.retire(owner, frame);
  add_one(counts_.evictions);
}

Result<void> PageCache::pin(std::uint32_t page) noexcept {
  assert(page < limits_.page_count);
  Error why = make_error(ErrorCode::kDamaged, page, Error::kNowhere,
                         "page %u was found unreadable before: rebuild the file", page);
  for (std::uint32_t attempt = 0;; ++attempt) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      const Attempt outcome = try_make_resident(pin_owner(), page, &why);
      if (outcome == Attempt::kUnreadable) return why;
      if (outcome == Attempt::kResident) return pin_resident(page);
    }
    wait_for_sections(attempt);
  }
}

Result<void> PageCache::pin_resident(std::uint32_t page) noexcept {
  const std::uint32_t frame = map_.frame_of(page);
  if (clock_.state(frame) == ClockPolicy::State::kPinned) return {};
  const std::uint32_t frame_count = frames_.frame_count();
  const std::uint32_t places = limits_.max_readers + 1;
  // See fetch() for why so many must stay unpinned.
  if (frame_count < limits_.page_count && frame_count - pinned_count_ <= places) {
    return make_error(ErrorCode::kNoMemory, page, Error::kNowhere,
                      "pinning more than %u of %u frames leaves too few for asking: "
                      "raise the memory budget",
                      pinned_count_, frame_count);
  }
  clock_.pin(frame);
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
  stats.frame_count = frames_.frame_count();
  stats.arena_bytes = frames_.arena_bytes();
  stats.table_bytes = table_memory_.bytes();
  stats.reserved_bytes = limits_.reserved_bytes;
  stats.budget_bytes = limits_.budget_bytes;
  stats.locked_bytes = locked_bytes_;
  return stats;
}

}  // namespace planetree::cache
