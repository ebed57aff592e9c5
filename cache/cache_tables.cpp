#include "cache/cache_tables.h"

#include <cassert>

#include "cache/arena_layout.h"

namespace planetree::cache {
namespace {

CacheTables cut_tables(const CacheLimits& limits, std::uint64_t frame_count,
                       Cutter& cutter) noexcept {
  const std::uint64_t page_count = limits.page_count;
  const std::uint64_t slot_count = limits.max_readers;
  const std::uint64_t owner_count = slot_count + 1;
  CacheTables tables;
  tables.map = cutter.cut<PageMap::Cell>(page_count);
  tables.quarantine_bits = cutter.cut<std::uint64_t>((page_count + 63) / 64);
  tables.policy.states = cutter.cut<FrameStates::State>(frame_count);
  if (limits.policy == Policy::kLru) {
    tables.policy.now = cutter.cut<LruPolicy::Tick>(1);
    tables.policy.uses = cutter.cut<LruPolicy::Tick>(frame_count);
    tables.policy.entries = cutter.cut<LruPolicy::Entry>(frame_count);
  } else {
    tables.policy.scores = cutter.cut<ClockPolicy::Score>(frame_count);
  }
  tables.pages = cutter.cut<std::uint32_t>(frame_count);
  tables.free_frames = cutter.cut<std::uint32_t>(frame_count);
  tables.slots = cutter.cut<ReaderSlot>(slot_count);
  tables.places = cutter.cut<Limbo::Place>(owner_count);
  tables.stamps = cutter.cut<std::uint64_t>(owner_count * slot_count);
  tables.errands = cutter.cut<Errand>(owner_count);
  return tables;
}

}  // namespace

std::uint64_t tables_bytes(const CacheLimits& limits, std::uint32_t frame_count) noexcept {
  Cutter cutter(nullptr);
  cut_tables(limits, frame_count, cutter);
  return cutter.used_bytes();
}

CacheTables make_tables(const CacheLimits& limits, std::uint32_t frame_count,
                        const ClaimedMemory& memory) noexcept {
  Cutter cutter(memory.data());
  const CacheTables tables = cut_tables(limits, frame_count, cutter);
  assert(cutter.used_bytes() <= memory.bytes());
  return tables;
}

}  // namespace planetree::cache
