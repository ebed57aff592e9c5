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
  struct Entry {
    std::uint32_t frame = kNoFrame;
    bool awaited = false;  ///< the owner is waiting for this very frame
  };

  /// `places` has one element per owner; `stamps` one per owner and slot, by
  /// owners.
  BasicLimbo(std::span<const Slot> slots, std::span<Entry> entries,
             std::span<std::uint64_t> stamps) noexcept;

  bool holds(std::uint32_t fetcher) const noexcept { return entries_[fetcher].frame != kNoFrame; }

  /// Puts a frame whose page has just been withdrawn from the map into the
  /// owner's empty place, noting the sections now open (E3, E4).
  void retire(std::uint32_t fetcher, std::uint32_t frame) noexcept;

  /// Says whether the owner waits for its frame; else anyone may take it.
  void set_awaited(std::uint32_t fetcher, bool awaited) noexcept {
    entries_[fetcher].awaited = awaited;
  }

  /// Takes out the owner's frame if its sections are over (E5); else kNoFrame.
  std::uint32_t take(std::uint32_t fetcher) noexcept;

  /// Takes out a frame that nobody waits for and whose sections are over.
  std::uint32_t take_unawaited() noexcept;

  /// Moves a frame that nobody waits for to the owner's empty place, and the sections it waits
  /// for with it; false if there is none.
  bool adopt(std::uint32_t fetcher) noexcept;

 private:
  bool sections_are_over(std::uint32_t fetcher) const noexcept;
  std::span<std::uint64_t> stamps_of(std::uint32_t fetcher) const noexcept {
    return stamps_.subspan(fetcher * slots_.size(), slots_.size());
  }

  // A stamp of 0, being even, means that there is no section to wait for.
  static constexpr std::uint64_t kNoSection = 0;

  std::span<const Slot> slots_;
  std::span<Entry> entries_;
  std::span<std::uint64_t> stamps_;
};

template <class Atomics>
BasicLimbo<Atomics>::BasicLimbo(std::span<const Slot> slots, std::span<Entry> entries,
                                std::span<std::uint64_t> stamps) noexcept
    : slots_(slots), entries_(entries), stamps_(stamps) {
  assert(stamps.size() == entries.size() * slots.size());
}

template <class Atomics>
void BasicLimbo<Atomics>::retire(std::uint32_t fetcher, std::uint32_t frame) noexcept {
  assert(!holds(fetcher) && frame != kNoFrame);
  const std::span<std::uint64_t> stamps = stamps_of(fetcher);
  for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
    const std::uint64_t sequence = slots_[slot].sequence_after_withdrawal();
    stamps[slot] = Slot::is_inside(sequence) ? sequence : kNoSection;
  }
  entries_[fetcher].frame = frame;
}

template <class Atomics>
bool BasicLimbo<Atomics>::sections_are_over(std::uint32_t fetcher) const noexcept {
  const std::span<const std::uint64_t> stamps = stamps_of(fetcher);
  for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
    if (stamps[slot] == kNoSection) continue;
    if (slots_[slot].sequence_before_reuse() == stamps[slot]) return false;
  }
  return true;
}

template <class Atomics>
std::uint32_t BasicLimbo<Atomics>::take(std::uint32_t fetcher) noexcept {
  Entry& entry = entries_[fetcher];
  if (entry.frame == kNoFrame || !sections_are_over(fetcher)) return kNoFrame;
  const std::uint32_t frame = entry.frame;
  entry = Entry{};
  return frame;
}

template <class Atomics>
std::uint32_t BasicLimbo<Atomics>::take_unawaited() noexcept {
  for (std::uint32_t fetcher = 0; fetcher < entries_.size(); ++fetcher) {
    if (entries_[fetcher].awaited) continue;
    if (const std::uint32_t frame = take(fetcher); frame != kNoFrame) return frame;
  }
  return kNoFrame;
}

template <class Atomics>
bool BasicLimbo<Atomics>::adopt(std::uint32_t fetcher) noexcept {
  assert(!holds(fetcher));
  for (std::uint32_t other = 0; other < entries_.size(); ++other) {
    if (!holds(other) || entries_[other].awaited) continue;
    const std::span<const std::uint64_t> stamps = stamps_of(other);
    std::copy(stamps.begin(), stamps.end(), stamps_of(fetcher).begin());
    entries_[fetcher].frame = std::exchange(entries_[other].frame, kNoFrame);
    return true;
  }
  return false;
}

using Limbo = BasicLimbo<>;

}  // namespace planetree::cache
