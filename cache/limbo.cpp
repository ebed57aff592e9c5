#include "cache/limbo.h"

#include <cassert>
#include <cstddef>

namespace planetree::cache {

Limbo::Limbo(std::span<const ReaderSlot> slots, std::span<Place> places,
             std::span<std::uint64_t> stamps) noexcept
    : slots_(slots), places_(places), stamps_(stamps) {
  assert(stamps.size() == places.size() * slots.size());
}

void Limbo::retire(std::uint32_t owner, std::uint32_t frame) noexcept {
  assert(!holds(owner) && frame != kNoFrame);
  const std::span<std::uint64_t> stamps = stamps_of(owner);
  for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
    const std::uint64_t sequence = slots_[slot].sequence_after_withdrawal();
    stamps[slot] = ReaderSlot::is_inside(sequence) ? sequence : kNoSection;
  }
  places_[owner].frame = frame;
}

bool Limbo::sections_are_over(std::uint32_t owner) const noexcept {
  const std::span<const std::uint64_t> stamps = stamps_of(owner);
  for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
    if (stamps[slot] == kNoSection) continue;
    if (slots_[slot].sequence_before_reuse() == stamps[slot]) return false;
  }
  return true;
}

std::uint32_t Limbo::take(std::uint32_t owner) noexcept {
  Place& place = places_[owner];
  if (place.frame == kNoFrame || !sections_are_over(owner)) return kNoFrame;
  const std::uint32_t frame = place.frame;
  place = Place{};
  return frame;
}

std::uint32_t Limbo::take_unawaited() noexcept {
  for (std::uint32_t owner = 0; owner < places_.size(); ++owner) {
    if (places_[owner].awaited) continue;
    if (const std::uint32_t frame = take(owner); frame != kNoFrame) return frame;
  }
  return kNoFrame;
}

}  // namespace planetree::cache
