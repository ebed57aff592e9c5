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

/// Every array of a PageCache other than its frames, in one claimed memory: so
/// readers' lookups fault no page in, and the bytes counted are the bytes held.
struct CacheTables {
  // By page.
  std::span<PageMap::Cell> map;
  std::span<std::uint64_t> quarantine_bits;  ///< 64 pages a word
  // By frame.
  PolicyTables policy;
  std::span<std::uint32_t> pages;        ///< the page in each frame that has one
  std::span<std::uint32_t> free_frames;  ///< a stack
  // By reader, and one more owner: pin().
  std::span<ReaderSlot> slots;
  std::span<Limbo::Entry> entries;
  std::span<std::uint64_t> stamps;
  std::span<InFlightRead> in_flight_reads;
};

/// Bytes of the tables of a cache with `frame_count` frames.
std::uint64_t tables_bytes(const CacheLimits& limits, std::uint32_t frame_count) noexcept;

/// Makes the tables in `memory`, which has at least tables_bytes().
CacheTables make_tables(const CacheLimits& limits, std::uint32_t frame_count,
                        const PrefaultedMemory& memory) noexcept;

}  // namespace planetree::cache
