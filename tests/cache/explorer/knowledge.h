#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace planetree::explorer {

inline constexpr std::size_t kMaxThreads = 4;
inline constexpr std::size_t kMaxAtomics = 32;

/// One step of one thread. The steps of a thread are numbered from 1.
struct Step {
  std::uint32_t thread = 0;
  std::uint16_t time = 0;  ///< 0: before all threads began
};

/// The set of steps that happen before a point of a run, as a vector clock. Each thread has one. A
/// release store saves a copy of it, and an acquire load that reads the store adds that copy to its
/// own thread's.
class Knowledge {
 public:
  /// Whether `step` happens before this point.
  bool includes(Step step) const noexcept { return step.time <= times_[step.thread]; }

  /// The last step of a thread that happens before this point.
  std::uint16_t time_of(std::uint32_t thread) const noexcept { return times_[thread]; }
  void set_time(Step step) noexcept { times_[step.thread] = step.time; }

  /// The oldest store to an atomic that may still be read, as its index in the modification order.
  /// A thread that knows of a store, or of a load that read it, reads no older one. This covers all
  /// of coherence: write-read and read-read by this index, write-write and read-write because a new
  /// store is always appended.
  std::uint16_t oldest_visible(std::size_t atomic) const noexcept { return oldest_[atomic]; }
  void saw(std::size_t atomic, std::size_t store) noexcept {
    oldest_[atomic] = std::max(oldest_[atomic], static_cast<std::uint16_t>(store));
  }

  void add(const Knowledge& other) noexcept {
    for (std::size_t i = 0; i < kMaxThreads; ++i) {
      times_[i] = std::max(times_[i], other.times_[i]);
    }
    for (std::size_t i = 0; i < kMaxAtomics; ++i) {
      oldest_[i] = std::max(oldest_[i], other.oldest_[i]);
    }
  }

 private:
  std::array<std::uint16_t, kMaxThreads> times_{};
  std::array<std::uint16_t, kMaxAtomics> oldest_{};
};

}  // namespace planetree::explorer
