#pragma once

#include <atomic>
#include <cstdint>

namespace planetree::cache {

/// Steps of the protocol between readers and the writer. Apart from the mutex these are the only
/// places where the memory order matters. reader_slot.h and page_map.h justify the order of each
/// step. R, E and I number the steps of reading, evicting and installing a page.
enum class ProtocolStep : std::uint8_t {
  kClaim,          ///< a new reader continues the sequence and counts of the slot's last reader
  kRelease,        ///< a reader hands the slot on; the other side of kClaim
  kEnter,          ///< R1: a reader begins a section
  kFind,           ///< R2: the reader looks up a page
  kLeave,          ///< R5: the reader ends the section
  kWithdraw,       ///< E2: the writer hides a page
  kNoteSections,   ///< E3: the writer notes which sections are open
  kSeeSectionEnd,  ///< E5: the writer finds that a noted section has ended
  kPublish,        ///< I7: the writer shows a filled frame
};

/// Memory order of each step.
constexpr std::memory_order order_of(ProtocolStep step) noexcept {
  switch (step) {
    case ProtocolStep::kEnter:
    case ProtocolStep::kFind:
    case ProtocolStep::kWithdraw:
    case ProtocolStep::kNoteSections:
      return std::memory_order_seq_cst;
    case ProtocolStep::kClaim:
    case ProtocolStep::kSeeSectionEnd:
      return std::memory_order_acquire;
    case ProtocolStep::kRelease:
    case ProtocolStep::kLeave:
    case ProtocolStep::kPublish:
      return std::memory_order_release;
  }
  return std::memory_order_seq_cst;
}

/// Atomics and memory orders of the protocol's classes. These are templates over this type, so
/// that tests can run the same code over atomics that show every behaviour the language allows,
/// and with one order weakened at a time.
struct StdAtomics {
  template <class T>
  using Atomic = std::atomic<T>;

  static constexpr std::memory_order order(ProtocolStep step) noexcept { return order_of(step); }
};

}  // namespace planetree::cache
