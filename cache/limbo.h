#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "cache/policy/frame_states.h"
#include "cache/protocol.h"

namespace planetree::cache {

/// Frames whose page has been withdrawn from the page map but that readers may still be reading.
/// A frame can be reused once all sections that were open when it was retired have ended.
///
/// There is one entry per fetcher, which bounds the number of frames in limbo. A second entry
/// would not help a fetcher: the sections open when the second frame is retired include all that
/// the first frame still waits for, so the second is never ready earlier.
///
/// Only the writer, the holder of the cache's mutex, may call it. A view of memory that PageCache
/// owns.
template <class Atomics = StdAtomics>
class BasicLimbo {
 public:
  using Slot = BasicReaderSlot<Atomics>;

  /// A fetcher's retired frame, if any.
  struct Entry {
    std::uint32_t frame = kNoFrame;
    bool awaited = false;  ///< the fetcher is waiting for this frame
  };

  /// slots    one per reader.
  /// entries  one per fetcher.
  /// stamps   one per fetcher and slot, ordered by fetcher.
  BasicLimbo(std::span<const Slot> slots, std::span<Entry> entries,
             std::span<std::uint64_t> stamps) noexcept;

  bool holds(std::uint32_t fetcher) const noexcept { return entries_[fetcher].frame != kNoFrame; }

  /// Puts a frame whose page has just been withdrawn from the page map into the fetcher's empty
  /// entry and notes the sections now open (E3, E4).
  void retire(std::uint32_t fetcher, std::uint32_t frame) noexcept;

  /// States whether the fetcher waits for its frame. Any fetcher may take a frame that is not
  /// awaited.
  void set_awaited(std::uint32_t fetcher, bool awaited) noexcept {
    entries_[fetcher].awaited = awaited;
  }

  /// Removes and returns the fetcher's frame if its sections have ended (E5); otherwise kNoFrame.
  std::uint32_t take(std::uint32_t fetcher) noexcept;

  /// Removes and returns a frame that is not awaited and whose sections have ended; kNoFrame if
  /// there is none.
  std::uint32_t take_unawaited() noexcept;

  /// Moves a frame that is not awaited, with the sections it waits for, to the fetcher's empty
  /// entry. Returns false if there is none.
  bool adopt(std::uint32_t fetcher) noexcept;

 private:
  bool sections_are_over(std::uint32_t fetcher) const noexcept;
  std::span<std::uint64_t> stamps_of(std::uint32_t fetcher) const noexcept {
    return stamps_.subspan(fetcher * slots_.size(), slots_.size());
  }

  // Sequence numbers inside sections are odd, so 0 can stand for "no section to wait for".
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
