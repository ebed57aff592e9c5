#pragma once

#include <cstdint>

namespace planetree::tools {

/// What the system granted a thread that must not be late.
struct RealTimeRights {
  bool fifo = false;    ///< it runs before all ordinary threads
  bool pinned = false;  ///< to one processor
};

/// Queries for the calling thread to run first, on the machine's last processor.
RealTimeRights become_real_time() noexcept;

/// What the calling thread has cost the system so far.
struct ThreadUsage {
  std::uint64_t faults = 0;  ///< of pages, major and minor
  std::uint64_t switches_wanted = 0;
  std::uint64_t switches_forced = 0;
};
ThreadUsage thread_usage() noexcept;

}  // namespace planetree::tools
