#include "query/serve/query_arena.h"

#include <array>

#include "cache/prefaulted_memory.h"

namespace planetree::query {
namespace {

constexpr std::size_t kLineBytes = 64;

struct alignas(kLineBytes) Line {
  std::array<std::byte, kLineBytes> bytes;
};

// Number of cache lines for so many bytes.
constexpr std::uint64_t lines(std::uint64_t bytes) { return (bytes + kLineBytes - 1) / kLineBytes; }

QueryArena::Parts cut(cache::ArenaLayout& layout, const QueryArena::Needs& needs) noexcept {
  QueryArena::Parts parts;
  parts.model = std::as_writable_bytes(layout.cut<Line>(lines(needs.model_bytes)));
  parts.probes = std::as_writable_bytes(layout.cut<Line>(needs.readers * lines(needs.probe_bytes)));
  parts.contacts =
      std::as_writable_bytes(layout.cut<Line>(lines(needs.readers * needs.contact_bytes)));
  parts.fetch_requests = layout.cut<FetchRequests>(needs.readers);
  parts.field = std::as_writable_bytes(layout.cut<Line>(lines(needs.field_bytes)));
  parts.side_grid = layout.cut<std::byte>(needs.side_grid_bytes);
  if (needs.page_trace_capacity == 0) return parts;
  const std::uint64_t slots = PageTrace::Ring::slots_for(needs.page_trace_capacity);
  const auto traces = layout.cut<PageTraces>(1);
  const auto of_readers = layout.cut<PageTrace>(needs.readers);
  const auto cursors = layout.cut<TraceCursor>(needs.readers);
  const auto states = layout.cut<std::uint8_t>(needs.page_count);
  const auto all_slots = layout.cut<PageTrace::Ring::Slot>(needs.readers * slots);
  // While the layout only measures, there are no traces.
  if (traces.empty()) return parts;
  parts.traces = traces.data();
  parts.traces->of_readers = of_readers;
  parts.traces->cursors = cursors;
  parts.traces->states_of_pages = states;
  for (std::size_t i = 0; i < of_readers.size(); ++i)
    of_readers[i].attach(parts.traces->clock, all_slots.subspan(i * slots, slots));
  return parts;
}

std::uint64_t cut_bytes(const QueryArena::Needs& needs) noexcept {
  cache::ArenaLayout measure(nullptr);
  cut(measure, needs);
  return measure.used_bytes();
}

}  // namespace

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
