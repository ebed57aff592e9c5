#pragma once

#include <cassert>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "cache/eviction_policy.h"
#include "cache/page_map.h"
#include "cache/reader_slot.h"

namespace planetree::cache {

class PageCache;

/// How a fetch goes about a page that is not resident.
struct FetchTerms {
  static constexpr std::chrono::milliseconds kNoLimit = std::chrono::milliseconds::max();

  /// Reads it; else only what a disk gives in a moment, and for the rest waits for a helper: a
  /// thread that calls Reader::help().
  bool reads_itself = true;
  /// How long to wait for a page that another reads.
  std::chrono::milliseconds wait_limit = kNoLimit;
};

/// What a fetch brought.
struct Fetched {
  const std::byte* frame = nullptr;  ///< nullptr if the page is unreadable, or was given up
  bool given_up = false;             ///< the limit was reached; another fetch may have it
};

/// One thread's access to the pages of a PageCache, which must outlive it.
/// Move-only; gives its slot back when destroyed. Not for two threads at once.
///
/// Pages are read inside sections. A pointer to a frame is valid until the
/// next leave() or fetch(); keep page numbers across these, not pointers.
/// Sections must be short (some hundred lookups) and must not wait for
/// anything, because other threads' fetches wait for them to end.
class Reader {
 public:
  Reader(Reader&& other) noexcept;
  Reader& operator=(Reader&& other) noexcept;
  ~Reader();

  /// Begins a section; not inside one. No lock, allocation or system call.
  void enter() noexcept { slot_->enter(); }

  /// Ends the section. No lock, allocation or system call.
  void leave() noexcept { slot_->leave(); }

  bool inside() const noexcept { return slot_->inside(); }

  /// Among the readers there are at one time.
  std::uint32_t index() const noexcept { return index_; }

  /// Inside a section: the frame of a page number below page_count, or nullptr
  /// if it is not resident. No lock, allocation, loop or system call.
  const std::byte* find(std::uint32_t page) noexcept {
    assert(inside());
    const std::uint32_t frame = map_.find(page);
    if (frame == kNoFrame) {
      slot_->count_miss();
      return nullptr;
    }
    slot_->count_hit();
    marks_.mark(frame);
    return at(frame);
  }

  /// As find(), for a glance: counts and marks nothing.
  const std::byte* peek(std::uint32_t page) const noexcept {
    assert(inside());
    const std::uint32_t frame = map_.find(page);
    return frame == kNoFrame ? nullptr : at(frame);
  }

  /// Where pages are: good as long as the cache is, for looks at what may change meanwhile.
  const PageMap& map() const noexcept { return map_; }
  const std::byte* frames() const noexcept { return frames_; }
  std::uint64_t stride_bytes() const noexcept { return stride_bytes_; }

  /// Inside a section: ends it, makes the page resident, begins another and
  /// returns the page's frame; nullptr if the page is unreadable. All pointers
  /// found before are invalid.
  ///
  /// The frame keeps the page's bytes until the section ends, even if others
  /// evict the page at once so that find() no longer shows it. So read what is
  /// needed from the pointer returned; do not start again from find(), or
  /// threads may take each other's pages for ever.
  ///
  /// May wait for the disk, for other fetches and for other readers' sections:
  /// not for threads that must answer in time.
  const std::byte* fetch(std::uint32_t page) noexcept { return fetch(page, {}).frame; }
  Fetched fetch(std::uint32_t page, const FetchTerms& terms) noexcept;

  /// Outside a section: reads the page that another has waited for longest of those that nobody
  /// reads; false if there is none.
  bool help() noexcept;

 private:
  friend class PageCache;
  Reader(PageCache& cache, ReaderSlot& slot, std::uint32_t index) noexcept;
  void give_back() noexcept;
  const std::byte* at(std::uint32_t frame) const noexcept {
    return frames_ + frame * stride_bytes_;
  }

  // Copies of what find() needs, so that it does not touch the cache object,
  // whose lines the writer keeps changing.
  PageMap map_;
  ReferenceBits marks_;
  const std::byte* frames_;
  std::uint64_t stride_bytes_;
  ReaderSlot* slot_;  // nullptr once moved from
  std::uint32_t index_;
  PageCache* cache_;
};

}  // namespace planetree::cache
