#include "query/serve/query_arena.h"

#include <array>

#include "cache/arena_layout.h"
#include "query/model_state.h"
#include "query/probe_state.h"

namespace planetree::query {
namespace {

/// Room for an object that is made later, and destroyed by who made it.
template <class T>
struct alignas(64) Room {
  static_assert(alignof(T) <= 64);
  std::array<std::byte, sizeof(T)> bytes;
};

AskingMemory::Parts cut(cache::Cutter& cutter, const AskingMemory::Needs& needs) noexcept {
  AskingMemory::Parts parts;
  parts.model_room = cutter.cut<Room<ModelState>>(1).data();
  parts.probe_rooms = std::as_writable_bytes(cutter.cut<Room<ProbeState>>(needs.readers)).data();
  parts.wishes = cutter.cut<Wishes>(needs.readers);
  parts.colours = cutter.cut<std::byte>(needs.colour_bytes);
  if (needs.trace_touches == 0) return parts;
  using Ring = cache::TraceRing<Touch>;
  const std::uint64_t slots = Ring::slots_for(needs.trace_touches);
  parts.traces = cutter.cut<TouchTrace>(needs.readers);
  parts.marks = cutter.cut<PrefetchMark>(needs.page_count);
  const auto all_slots = cutter.cut<Ring::Slot>(needs.readers * slots);
  // Where there is no memory yet, these are none.
  for (std::size_t i = 0; i < parts.traces.size(); ++i)
    parts.traces[i].ring.attach(all_slots.subspan(i * slots, slots));
  return parts;
}

std::uint64_t cut_bytes(const AskingMemory::Needs& needs) noexcept {
  cache::Cutter measure(nullptr);
  cut(measure, needs);
  return measure.used_bytes();
}

}  // namespace

void* AskingMemory::Parts::probe_room(std::uint32_t place) const noexcept {
  return probe_rooms + place * sizeof(Room<ProbeState>);
}

std::uint64_t AskingMemory::bytes(const Needs& needs) noexcept {
  return cache::ClaimedMemory::claimed_bytes(cut_bytes(needs));
}

Result<AskingMemory> AskingMemory::claim(const Needs& needs) noexcept {
  auto memory = cache::ClaimedMemory::claim(cut_bytes(needs));
  if (!memory) return memory.error();
  cache::Cutter cutter(memory->data());
  const Parts parts = cut(cutter, needs);
  return AskingMemory(*std::move(memory), parts);
}

}  // namespace planetree::query
