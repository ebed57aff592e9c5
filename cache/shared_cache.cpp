// The files of a shared PageCache, and the memory that frames lend for them.
//
// A frame that lends its memory is in no list and has no page, so that neither readers nor fetches
// use it. So many frames keep their memory that each fetch ends: see page_fetch.cpp.

#include <algorithm>
#include <cassert>
#include <cinttypes>

#include "cache/page_cache.h"

namespace planetree::cache {

Result<std::uint32_t> PageCache::add_file(std::uint32_t page_count, std::uint64_t bytes) noexcept {
  assert(limits_.is_shared && page_count > 0);
  Lock lock(mutex_);
  const std::uint32_t first = files_.add(page_count);
  if (first == PageRanges::kNone)
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "%u pages are too many beside those of the other files: remove a file",
                      page_count);
  ++file_count_;
  const std::uint32_t end = std::max(backed_pages_, first + page_count);
  const std::uint64_t table_bytes =
      page_tables_bytes(limits_, end) - page_tables_bytes(limits_, backed_pages_);
  Result<void> done = lend(lock, bytes + table_bytes);
  if (done) {
    done = back_tables(end);
    if (done) return first;
    lent_bytes_ -= bytes + table_bytes;
  }
  files_.remove(first);
  --file_count_;
  return done.error();
}

void PageCache::remove_file(std::uint32_t first, std::uint64_t bytes) noexcept {
  Lock lock(mutex_);
  const std::uint32_t end = first + files_.remove(first);
  for (std::uint32_t page = first; page < end; ++page) forget(page);
  --file_count_;
  lent_bytes_ -= bytes;
  const std::uint64_t stride = frames_.stride_bytes();
  const auto needed = static_cast<std::uint32_t>((lent_bytes_ + stride - 1) / stride);
  reclaim_frames(discarded_count_.load(std::memory_order_relaxed) - needed);
}

Reader PageCache::window(std::uint32_t reader_index, std::uint32_t first_page) noexcept {
  Reader reader(*this, tables_.slots[reader_index], reader_index, first_page);
  reader.owns_slot_ = false;
  return reader;
}

// Takes the memory of so many frames that those taken so far suffice for what is lent.
Result<void> PageCache::lend(Lock& lock, std::uint64_t bytes) noexcept {
  const std::uint64_t stride = frames_.stride_bytes();
  const std::uint64_t wanted = (lent_bytes_ + bytes + stride - 1) / stride;
  const std::uint64_t kept = std::uint64_t{limits_.max_readers} + 1 + file_count_;
  if (wanted + kept > frames_.frame_count())
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "%" PRIu64
                      " bytes are lacking for this file beside the others: raise the "
                      "memory budget by them, or remove a file",
                      (wanted + kept - frames_.frame_count()) * stride);
  const std::uint32_t discarded = discarded_count_.load(std::memory_order_relaxed);
  if (wanted > discarded) discard_frames(lock, static_cast<std::uint32_t>(wanted) - discarded);
  lent_bytes_ += bytes;
  return {};
}

// Free frames that are used last go first: they are neighbours, so that huge pages stay whole.
void PageCache::discard_frames(Lock& lock, std::uint32_t count) noexcept {
  const auto discard = [this](std::uint32_t frame) {
    frames_.discard(frame);
    const std::uint32_t discarded = discarded_count_.load(std::memory_order_relaxed);
    tables_.free_frames[frames_.frame_count() - 1 - discarded] = frame;
    discarded_count_.store(discarded + 1, std::memory_order_relaxed);
  };
  const std::uint32_t last = std::min(count, free_count_);
  const std::span<std::uint32_t> free = tables_.free_frames.first(free_count_);
  std::rotate(free.begin(), free.begin() + last, free.end());
  free_count_ -= last;
  // The entries of these frames may be overwritten while they are moved to the end: highest first.
  for (std::uint32_t i = last; i > 0; --i) discard(free[free_count_ + i - 1]);
  for (std::uint32_t attempt = 0, left = count - last; left > 0; ++attempt) {
    limbo_.set_awaited(pin_fetcher(), false);
    const std::uint32_t frame = take_frame(lock, pin_fetcher(), attempt);
    if (frame == kNoFrame) continue;
    discard(frame);
    --left;
  }
}

// A frame that the system has no memory for stays discarded.
void PageCache::reclaim_frames(std::uint32_t count) noexcept {
  for (; count > 0; --count) {
    const std::uint32_t discarded = discarded_count_.load(std::memory_order_relaxed);
    const std::uint32_t frame = tables_.free_frames[frames_.frame_count() - discarded];
    if (!frames_.reclaim(frame, locked_bytes_ > 0)) return;
    discarded_count_.store(discarded - 1, std::memory_order_relaxed);
    tables_.free_frames[free_count_++] = frame;
  }
}

// Backs the tables of the pages below `page_count` that are not backed yet.
Result<void> PageCache::back_tables(std::uint32_t page_count) noexcept {
  const auto back = [this](auto table, std::uint64_t begin, std::uint64_t end) -> Result<void> {
    if (table.empty() || begin == end) return {};
    const auto* const base = reinterpret_cast<const std::byte*>(table.data());
    const auto offset = static_cast<std::uint64_t>(base - page_memory_->data());
    constexpr std::uint64_t kBytes = sizeof table[0];
    return page_memory_->commit(offset + begin * kBytes, (end - begin) * kBytes, locked_bytes_ > 0);
  };
  const std::uint64_t begin = backed_pages_;
  if (const auto done = back(tables_.map, begin, page_count); !done) return done;
  if (const auto done = back(tables_.quarantine_bits, begin / 64, (page_count + 63) / 64); !done)
    return done;
  if (const auto done = back(tables_.policy.ghosts, begin, page_count); !done) return done;
  backed_pages_ = page_count;
  return {};
}

// Nobody uses the page, so that its frame need not pass through limbo.
void PageCache::forget(std::uint32_t page) noexcept {
  tables_.quarantine_bits[page / 64] &= ~(std::uint64_t{1} << page % 64);
  const std::uint32_t frame = map_.frame_of(page);
  if (frame == kNoFrame) return;
  if (evictor_.state(frame) == Evictor::State::kPinned) {
    evictor_.unpin(frame);
    --pinned_count_;
  }
  evictor_.remove(frame);
  map_.withdraw(page);
  tables_.free_frames[free_count_++] = frame;
  add_one(counts_.evictions);
}

}  // namespace planetree::cache
