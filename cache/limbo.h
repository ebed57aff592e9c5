#pragma once

#include <cstdint>
#include <span>

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
class Limbo {
 public:
  /// A retired frame's place.
  struct Place {
    std::uint32_t frame = kNoFrame;
    bool awaited = false;  ///< the owner is waiting for this very frame
  };

  /// `places` has one element per owner; `stamps` one per owner and slot, by
  /// owners.
  Limbo(std::span<const ReaderSlot> slots, std::span<Place> places,
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

 private:
  bool sections_are_over(std::uint32_t owner) const noexcept;
  std::span<std::uint64_t> stamps_of(std::uint32_t owner) const noexcept {
    return stamps_.subspan(owner * slots_.size(), slots_.size());
  }

  // A stamp of 0, being even, means that there is no section to wait for.
  static constexpr std::uint64_t kNoSection = 0;

  std::span<const ReaderSlot> slots_;
  std::span<Place> places_;
  std::span<std::uint64_t> stamps_;
};

}  // namespace planetree::cache
