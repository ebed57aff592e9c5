#pragma once

#include <cstdint>
#include <span>

#include "cache/cache_limits.h"
#include "cache/eviction_policy.h"
#include "cache/in_flight_reads.h"
#include "cache/limbo.h"
#include "cache/page_map.h"
#include "cache/prefaulted_memory.h"
#include "cache/reader_slot.h"

namespace planetree::cache {

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

/// Bytes that the tables of a cache with `frame_count` frames take.
std::uint64_t tables_bytes(const CacheLimits& limits, std::uint32_t frame_count) noexcept;

/// Creates the tables in `memory`, which must have at least tables_bytes() bytes and outlive them.
CacheTables make_tables(const CacheLimits& limits, std::uint32_t frame_count,
                        const PrefaultedMemory& memory) noexcept;

}  // namespace planetree::cache
