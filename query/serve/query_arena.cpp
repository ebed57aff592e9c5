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
  parts.fetch_requests = layout.cut<FetchRequests>(needs.readers);
  parts.field = std::as_writable_bytes(layout.cut<Line>(lines(needs.field_bytes)));
  parts.side_grid = layout.cut<std::byte>(needs.side_grid_bytes);
  if (needs.page_trace_capacity == 0) return parts;
  using Ring = cache::SpscRing<TracedAccess>;
  const std::uint64_t slots = Ring::slots_for(needs.page_trace_capacity);
  parts.traces = layout.cut<PageTrace>(needs.readers);
  parts.marks = layout.cut<PrefetchMark>(needs.page_count);
  const auto all_slots = layout.cut<Ring::Slot>(needs.readers * slots);
  // While the layout only measures, there are no traces.
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
