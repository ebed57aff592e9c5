#pragma once

#include <cstdint>
#include <span>

#include "cache/in_flight_reads.h"
#include "cache/limbo.h"
#include "cache/policy/policy_tables.h"
#include "cache/prefaulted_memory.h"
#include "cache/protocol.h"
#include "planetree/error.h"
#include "planetree/eviction_policy.h"

namespace planetree::cache {

/// Size and memory budget of a PageCache.
struct CacheLimits {
  std::uint64_t budget_bytes;    ///< hard ceiling for the cache and reserved_bytes together
  std::uint32_t page_count;      ///< pages are 0 ... page_count - 1; at least 1
  std::uint32_t frame_bytes;     ///< size of a decoded page; 1 ... kMaxFrameBytes
  std::uint32_t max_readers;     ///< maximum number of simultaneous readers; 1 ... kMaxReaders
  std::uint64_t reserved_bytes;  ///< part of the budget that the caller needs for itself
  EvictionPolicy policy = EvictionPolicy::kClock;
  std::uint32_t own_readers = 0;  ///< of max_readers: those that threads of the caller claim
  /// Number of pages that are never fetched, below page_count. No frame is kept for them.
  std::uint32_t unused_pages = 0;
  /// Whether the pages are those of files that come and go: see PageCache::add_file. The page
  /// numbers are then below page_count, of which none is in use at first.
  bool is_shared = false;

  /// Maximum number of pages in frames.
  std::uint32_t used_pages() const noexcept { return page_count - unused_pages; }
};

inline constexpr std::uint32_t kMaxFrameBytes = std::uint32_t{1} << 28;
/// The stamps in limbo.h take 8 * max_readers^2 bytes: 18 MiB with this many readers.
inline constexpr std::uint32_t kMaxReaders = 1536;

/// Returns kBadArgument for limits outside the ranges above.
Result<void> check_limits(const CacheLimits& limits) noexcept;

/// Minimum number of frames with which every fetch is certain to end: one for each entry in
/// limbo (one entry per reader and one for pin()), and one for a pinned root page. At most
/// used_pages(), because nothing is evicted where every page has a frame. In a shared cache one for
/// each entry; each file takes one more.
std::uint32_t minimum_frame_count(const CacheLimits& limits) noexcept;

/// Memory of a cache with `frame_count` frames plus reserved_bytes. This sum is compared with
/// the budget. Saturates.
std::uint64_t bytes_needed(const CacheLimits& limits, std::uint32_t frame_count) noexcept;

/// Smallest budget that PageCache::create() accepts. Ignores `limits.budget_bytes`.
std::uint64_t minimum_budget_bytes(const CacheLimits& limits) noexcept;

/// Maximum number of frames that fit in the budget, at most used_pages(); 0 if none fits.
std::uint32_t frames_within_budget(const CacheLimits& limits) noexcept;

/// All arrays of a PageCache except its frames. They lie in one PrefaultedMemory, so that
/// lookups by readers fault no page in and the bytes counted are the bytes held.
struct CacheTables {
  // Indexed by page.
  std::span<PageMap::Cell> map;
  std::span<std::uint64_t> quarantine_bits;  ///< 64 pages per word
  // Indexed by frame.
  PolicyTables policy;
  std::span<std::uint32_t> pages;        ///< page in each frame; unspecified in an idle frame
  std::span<std::uint32_t> free_frames;  ///< stack of free frames
  // Indexed by reader.
  std::span<ReaderSlot> slots;
  // Indexed by fetcher: one per reader, and a last one for pin().
  std::span<Limbo::Entry> entries;
  std::span<std::uint64_t> stamps;  ///< indexed by fetcher, then by reader
  std::span<InFlightRead> in_flight_reads;
};

/// Bytes that the tables of `page_count` pages of a shared cache take, which are not part of
/// tables_bytes().
std::uint64_t page_tables_bytes(const CacheLimits& limits, std::uint64_t page_count) noexcept;

/// Bytes that the tables of a cache with `frame_count` frames take.
std::uint64_t tables_bytes(const CacheLimits& limits, std::uint32_t frame_count) noexcept;

/// Creates the tables in `memory`, which must have at least tables_bytes() bytes and outlive them.
///
/// page_memory  of a shared cache: for the tables of page_count pages, at least
///              page_tables_bytes() bytes, all 0. They are not touched.
CacheTables make_tables(const CacheLimits& limits, std::uint32_t frame_count,
                        const PrefaultedMemory& memory,
                        const PrefaultedMemory* page_memory = nullptr) noexcept;

}  // namespace planetree::cache
