#pragma once

#include <atomic>
#include <cassert>
#include <cstdint>
#include <span>

#include "cache/protocol.h"

namespace planetree::query {

/// Tells which instances a scene has, to probes that never wait, and tells the thread that removes
/// one when no probe uses it any more.
///
/// A counter of changes takes the place of the page map in the protocol of the cache
/// (cache/protocol.h). With its steps:
///
///     probe                               remove
///     R1  sequence = odd                  E2  hide the instance, count a change
///     R2  read the counter                E3  read sequence
///     R2' if it is new, read instances
///
/// All four are seq_cst. So if E3 does not see R1, R2 sees the change of E2, and the probe finds
/// the instance gone. If E3 sees R1, the instance is kept until the sequence number changes (E5).
///
/// A view of memory that the scene owns.
template <class Atomics = cache::StdAtomics>
class BasicSceneSections {
 public:
  using Slot = cache::BasicReaderSlot<Atomics>;
  using Counter = typename Atomics::template Atomic<std::uint64_t>;

  /// slots  one for each probe
  BasicSceneSections(std::span<Slot> slots, Counter& changes) noexcept
      : slots_(slots), changes_(&changes) {}

  /// Begins a section of a probe and returns the number of changes so far.
  std::uint64_t enter(std::uint32_t probe) const noexcept {
    slots_[probe].enter();
    return changes_->load(Atomics::order(cache::ProtocolStep::kFind));
  }
  void leave(std::uint32_t probe) const noexcept { slots_[probe].leave(); }

  /// Counts a change. Any thread may call it. Waits for nothing.
  void count_change() const noexcept {
    changes_->fetch_add(1, Atomics::order(cache::ProtocolStep::kWithdraw));
  }

  std::size_t size() const noexcept { return slots_.size(); }
  /// Returns the section that a probe is in, or 0 if it is in none. Call it after count_change().
  std::uint64_t section_of(std::uint32_t probe) const noexcept {
    const std::uint64_t sequence = slots_[probe].sequence_after_withdrawal();
    return Slot::is_inside(sequence) ? sequence : 0;
  }
  /// Returns whether a section that section_of() returned has ended.
  bool is_over(std::uint32_t probe, std::uint64_t section) const noexcept {
    return section == 0 || slots_[probe].sequence_before_reuse() != section;
  }

 private:
  std::span<Slot> slots_;
  Counter* changes_;
};

using SceneSections = BasicSceneSections<>;

}  // namespace planetree::query
