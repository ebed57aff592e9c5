#include "cache/cache_tables.h"

#include <cassert>

#include "cache/arena_layout.h"

namespace planetree::cache {
namespace {

CacheTables cut_tables(const CacheLimits& limits, std::uint64_t frame_count,
                       ArenaLayout& layout) noexcept {
  const std::uint64_t page_count = limits.page_count;
  const std::uint64_t slot_count = limits.max_readers;
  const std::uint64_t fetcher_count = slot_count + 1;
  CacheTables tables;
  tables.map = layout.cut<PageMap::Cell>(page_count);
  tables.quarantine_bits = layout.cut<std::uint64_t>((page_count + 63) / 64);
  tables.policy.states = layout.cut<FrameStates::State>(frame_count);
  if (limits.policy == Policy::kLru) {
    tables.policy.now = layout.cut<LruPolicy::Tick>(1);
    tables.policy.uses = layout.cut<LruPolicy::Tick>(frame_count);
    tables.policy.entries = layout.cut<LruPolicy::Entry>(frame_count);
  } else {
    tables.policy.scores = layout.cut<ClockPolicy::Score>(frame_count);
  }
  tables.pages = layout.cut<std::uint32_t>(frame_count);
  tables.free_frames = layout.cut<std::uint32_t>(frame_count);
  tables.slots = layout.cut<ReaderSlot>(slot_count);
  tables.entries = layout.cut<Limbo::Entry>(fetcher_count);
  tables.stamps = layout.cut<std::uint64_t>(fetcher_count * slot_count);
  tables.in_flight_reads = layout.cut<InFlightRead>(fetcher_count);
  return tables;
}

}  // namespace

std::uint64_t tables_bytes(const CacheLimits& limits, std::uint32_t frame_count) noexcept {
  ArenaLayout layout(nullptr);
  cut_tables(limits, frame_count, layout);
  return layout.used_bytes();
}

CacheTables make_tables(const CacheLimits& limits, std::uint32_t frame_count,
                        const PrefaultedMemory& memory) noexcept {
  ArenaLayout layout(memory.data());
  const CacheTables tables = cut_tables(limits, frame_count, layout);
  assert(layout.used_bytes() <= memory.bytes());
  return tables;
}

}  // namespace planetree::cache
