#pragma once

#include <cassert>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "cache/policy/reference_bits.h"
#include "cache/protocol.h"

namespace planetree::cache {

class PageCache;

/// How a fetch gets a page that is not resident.
struct FetchTerms {
  static constexpr std::chrono::milliseconds kNoLimit = std::chrono::milliseconds::max();

  /// True: the fetch reads the page, however long the disk takes. False: it gives up a read that
  /// would block, and waits for a helper to read the page. A helper is a thread that calls
  /// Reader::help().
  bool reads_itself = true;
  /// Maximum time to wait for a page that another thread reads.
  std::chrono::milliseconds wait_limit = kNoLimit;
  /// When the waits for all pages end at the latest.
  std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();
};

/// Result of a fetch.
struct FetchResult {
  const std::byte* frame = nullptr;  ///< nullptr if the page is unreadable or `given_up` is true
  bool given_up =
      false;  ///< the wait limit has passed, or the page is late; a later fetch may succeed
};

/// One thread's access to the pages of a PageCache, which must outlive it. Move-only. The
/// destructor releases the reader slot. Only one thread at a time may use a Reader.
///
/// Pages are read inside sections. A pointer to a frame is valid until the next leave() or
/// fetch(); keep page numbers across these calls, not pointers. Sections must be short (some
/// hundred lookups) and must not wait for anything, because fetches of other threads wait for
/// them to end.
class Reader {
 public:
  Reader(Reader&& other) noexcept;
  Reader& operator=(Reader&& other) noexcept;
  ~Reader();

  /// Begins a section. Must not be called inside one. No lock, allocation or system call.
  void enter() noexcept { slot_->enter(); }

  /// Ends the section. No lock, allocation or system call.
  void leave() noexcept { slot_->leave(); }

  bool inside() const noexcept { return slot_->inside(); }

  /// Index of the reader slot, below max_readers; unique among simultaneous readers.
  std::uint32_t index() const noexcept { return index_; }

  /// Returns the frame of a page number below page_count, or nullptr if the page is not resident.
  /// Call it inside a section. No lock, allocation, loop or system call.
  const std::byte* find(std::uint32_t page) noexcept {
    assert(inside());
    const std::uint32_t frame = map_.find(page);
    if (frame == kNoFrame) {
      slot_->count_miss();
      return nullptr;
    }
    slot_->count_hit();
    reference_bits_.mark(frame);
    return at(frame);
  }

  /// Does what find() does without counting the lookup or recording a use.
  const std::byte* peek(std::uint32_t page) const noexcept {
    assert(inside());
    const std::uint32_t frame = map_.find(page);
    return frame == kNoFrame ? nullptr : at(frame);
  }

  /// The page map and the frames, for prefetching. They exist as long as the cache, but their
  /// content may change at any time.
  const PageMap& map() const noexcept { return map_; }
  const std::byte* frames() const noexcept { return frames_; }
  std::uint64_t stride_bytes() const noexcept { return stride_bytes_; }

  /// Ends the current section, makes the page resident, begins another section and returns the
  /// page's frame, or nullptr if the page is unreadable. Call it inside a section. All pointers
  /// found before become invalid.
  ///
  /// The frame keeps the page's bytes until the section ends, even if another thread evicts the
  /// page at once and find() no longer returns it. So use the pointer returned. Do not call find()
  /// again instead, or threads could evict each other's pages without end.
  ///
  /// May wait for the disk, for other fetches and for the sections of other readers. Not for
  /// real-time queries.
  const std::byte* fetch(std::uint32_t page) noexcept { return fetch(page, {}).frame; }
  FetchResult fetch(std::uint32_t page, const FetchTerms& terms) noexcept;

  /// Reads a page for another thread: among the pages that are waited for and that no thread reads,
  /// the one whose wait began first. Returns false if there is none. Call it outside of sections.
  bool help() noexcept;

 private:
  friend class PageCache;
  Reader(PageCache& cache, ReaderSlot& slot, std::uint32_t index,
         std::uint32_t first_page = 0) noexcept;
  void give_back() noexcept;
  const std::byte* at(std::uint32_t frame) const noexcept {
    return frames_ + frame * stride_bytes_;
  }

  // Copies of what find() needs, so that it does not read the PageCache object, whose cache lines
  // the writer changes.
  PageMap map_;
  ReferenceBits reference_bits_;
  const std::byte* frames_;
  std::uint64_t stride_bytes_;
  ReaderSlot* slot_;  // nullptr after a move
  std::uint32_t index_;
  std::uint32_t first_page_;  // number that the cache has for page 0; see PageCache::window
  bool owns_slot_ = true;
  PageCache* cache_;
};

}  // namespace planetree::cache
