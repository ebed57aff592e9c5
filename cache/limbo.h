#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "cache/frame_pool.h"
#include "cache/reader_slot.h"

namespace planetree::cache {

/// Frames whose page is hidden already, but which readers may still be
/// reading. Each waits for the sections that were open when it was retired.
///
/// There is one place for each thread that may fetch, called its owner, so the
/// frames in limbo are bounded by the number of owners. A second retired frame
/// would not help an owner anyway: the sections open when it is retired
/// include all that the first still waits for, so it is never ready earlier.
///
/// For the writer alone. A view of memory that PageCache owns.
template <class Atomics = StdAtomics>
class BasicLimbo {
 public:
  using Slot = BasicReaderSlot<Atomics>;

  /// A retired frame's place.
  struct Place {
    std::uint32_t frame = kNoFrame;
    bool awaited = false;  ///< the owner is waiting for this very frame
  };

  /// `places` has one element per owner; `stamps` one per owner and slot, by
  /// owners.
  BasicLimbo(std::span<const Slot> slots, std::span<Place> places,
             std::span<std::uint64_t> stamps) noexcept;

  bool holds(std::uint32_t owner) const noexcept { return places_[owner].frame != kNoFrame; }

  /// Puts a frame whose page has just been withdrawn from the map into the
  /// owner's empty place, noting the sections now open (E3, E4).
  void retire(std::uint32_t owner, std::uint32_t frame) noexcept;

  /// Says whether the owner waits for its frame; else anyone may take it.
  void set_awaited(std::uint32_t owner, bool awaited) noexcept { places_[owner].awaited = awaited; }

  /// Takes out the owner's frame if its sections are over (E5); else kNoFrame.
  std::uint32_t take(std::uint32_t owner) noexcept;

  /// Takes out a frame that nobody waits for and whose sections are over.
  std::uint32_t take_unawaited() noexcept;

  /// Moves a frame that nobody waits for to the owner's empty place, and the sections it waits
  /// for with it; false if there is none.
  bool adopt(std::uint32_t owner) noexcept;

 private:
  bool sections_are_over(std::uint32_t owner) const noexcept;
  std::span<std::uint64_t> stamps_of(std::uint32_t owner) const noexcept {
    return stamps_.subspan(owner * slots_.size(), slots_.size());
  }

  // A stamp of 0, being even, means that there is no section to wait for.
  static constexpr std::uint64_t kNoSection = 0;

  std::span<const Slot> slots_;
  std::span<Place> places_;
  std::span<std::uint64_t> stamps_;
};

template <class Atomics>
BasicLimbo<Atomics>::BasicLimbo(std::span<const Slot> slots, std::span<Place> places,
                                std::span<std::uint64_t> stamps) noexcept
    : slots_(slots), places_(places), stamps_(stamps) {
  assert(stamps.size() == places.size() * slots.size());
}

template <class Atomics>
void BasicLimbo<Atomics>::retire(std::uint32_t owner, std::uint32_t frame) noexcept {
  assert(!holds(owner) && frame != kNoFrame);
  const std::span<std::uint64_t> stamps = stamps_of(owner);
  for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
    const std::uint64_t sequence = slots_[slot].sequence_after_withdrawal();
    stamps[slot] = Slot::is_inside(sequence) ? sequence : kNoSection;
  }
  places_[owner].frame = frame;
}

template <class Atomics>
bool BasicLimbo<Atomics>::sections_are_over(std::uint32_t owner) const noexcept {
  const std::span<const std::uint64_t> stamps = stamps_of(owner);
  for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
    if (stamps[slot] == kNoSection) continue;
    if (slots_[slot].sequence_before_reuse() == stamps[slot]) return false;
  }
  return true;
}

template <class Atomics>
std::uint32_t BasicLimbo<Atomics>::take(std::uint32_t owner) noexcept {
  Place& place = places_[owner];
  if (place.frame == kNoFrame || !sections_are_over(owner)) return kNoFrame;
  const std::uint32_t frame = place.frame;
  place = Place{};
  return frame;
}

template <class Atomics>
std::uint32_t BasicLimbo<Atomics>::take_unawaited() noexcept {
  for (std::uint32_t owner = 0; owner < places_.size(); ++owner) {
    if (places_[owner].awaited) continue;
    if (const std::uint32_t frame = take(owner); frame != kNoFrame) return frame;
  }
  return kNoFrame;
}

template <class Atomics>
bool BasicLimbo<Atomics>::adopt(std::uint32_t owner) noexcept {
  assert(!holds(owner));
  for (std::uint32_t other = 0; other < places_.size(); ++other) {
    if (!holds(other) || places_[other].awaited) continue;
    const std::span<const std::uint64_t> stamps = stamps_of(other);
    std::copy(stamps.begin(), stamps.end(), stamps_of(owner).begin());
    places_[owner].frame = std::exchange(places_[other].frame, kNoFrame);
    return true;
  }
  return false;
}

using Limbo = BasicLimbo<>;

}  // namespace planetree::cache
