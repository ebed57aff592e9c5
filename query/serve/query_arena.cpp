#include "query/serve/query_arena.h"

#include <array>

#include "cache/arena_layout.h"
#include "query/model_state.h"
#include "query/probe_state.h"

namespace planetree::query {
namespace {

/// Storage for an object that is made later, and destroyed by who made it.
template <class T>
struct alignas(64) Storage {
  static_assert(alignof(T) <= 64);
  std::array<std::byte, sizeof(T)> bytes;
};

QueryArena::Parts cut(cache::ArenaLayout& layout, const QueryArena::Needs& needs) noexcept {
  QueryArena::Parts parts;
  parts.model_storage = layout.cut<Storage<ModelState>>(1).data();
  parts.probe_storage =
      std::as_writable_bytes(layout.cut<Storage<ProbeState>>(needs.readers)).data();
  parts.fetch_requests = layout.cut<FetchRequests>(needs.readers);
  parts.side_grid = layout.cut<std::byte>(needs.colour_bytes);
  if (needs.page_trace_capacity == 0) return parts;
  using Ring = cache::SpscRing<TracedAccess>;
  const std::uint64_t slots = Ring::slots_for(needs.page_trace_capacity);
  parts.traces = layout.cut<PageTrace>(needs.readers);
  parts.marks = layout.cut<PrefetchMark>(needs.page_count);
  const auto all_slots = layout.cut<Ring::Slot>(needs.readers * slots);
  // Where there is no memory yet, these are none.
  for (std::size_t i = 0; i < parts.traces.size(); ++i)
    parts.traces[i].ring.attach(all_slots.subspan(i * slots, slots));
  return parts;
}

std::uint64_t cut_bytes(const QueryArena::Needs& needs) noexcept {
  cache::ArenaLayout measure(nullptr);
  cut(measure, needs);
  return measure.used_bytes();
}

}  // namespace

void* QueryArena::Parts::storage_of_probe(std::uint32_t index) const noexcept {
  return probe_storage + index * sizeof(Storage<ProbeState>);
}

std::uint64_t QueryArena::bytes(const Needs& needs) noexcept {
  return cache::PrefaultedMemory::claimed_bytes(cut_bytes(needs));
}

Result<QueryArena> QueryArena::claim(const Needs& needs) noexcept {
  auto memory = cache::PrefaultedMemory::claim(cut_bytes(needs));
  if (!memory) return memory.error();
  cache::ArenaLayout layout(memory->data());
  const Parts parts = cut(layout, needs);
  return QueryArena(*std::move(memory), parts);
}

}  // namespace planetree::query
