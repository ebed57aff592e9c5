#pragma once

#include <atomic>
#include <cstdint>

namespace planetree::cache {

/// The steps by which readers and the writer understand each other, and, but
/// for the mutex among writers, the only places where the order of memory
/// matters. reader_slot.h says why each has the order it has; R, E and I are
/// the steps of reading, evicting and installing.
enum class ProtocolStep : std::uint8_t {
  kClaim,     ///< a slot's new owner continues where the last one stopped
  kGiveUp,    ///< the other half of kClaim
  kEnter,     ///< R1: a reader says that it is inside a section
  kFind,      ///< R2: it looks up a page
  kLeave,     ///< R5: it says that the section is over
  kWithdraw,  ///< E2: the writer hides a page
  kSeeOpen,   ///< E3: it notes which sections are open
  kSeeOver,   ///< E5: it finds that one of these is over
  kPublish,   ///< I7: it shows a filled frame
};

/// The order of each step.
constexpr std::memory_order order_of(ProtocolStep step) noexcept {
  switch (step) {
    case ProtocolStep::kEnter:
    case ProtocolStep::kFind:
    case ProtocolStep::kWithdraw:
    case ProtocolStep::kSeeOpen:
      return std::memory_order_seq_cst;
    case ProtocolStep::kClaim:
    case ProtocolStep::kSeeOver:
      return std::memory_order_acquire;
    case ProtocolStep::kGiveUp:
    case ProtocolStep::kLeave:
    case ProtocolStep::kPublish:
      return std::memory_order_release;
  }
  return std::memory_order_seq_cst;
}

/// What the classes of the protocol are made of. They are templates over this,
/// so that tests can run the very same code over atomics that show every
/// behaviour the language allows, and with one order weakened at a time.
struct StdAtomics {
  template <class T>
  using Atomic = std::atomic<T>;

  static constexpr std::memory_order order(ProtocolStep step) noexcept { return order_of(step); }
};

}  // namespace planetree::cache
