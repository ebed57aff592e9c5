#pragma once

#include <cstdint>

namespace planetree::tools {

/// What the system granted a real-time thread.
struct RealTimeRights {
  bool fifo = false;    ///< SCHED_FIFO: the thread runs before all ordinary threads
  bool pinned = false;  ///< the thread runs on one processor only
};

/// Requests SCHED_FIFO for the calling thread and pins it to the last processor that it may use.
RealTimeRights become_real_time() noexcept;

/// Page faults and context switches of a thread.
struct ThreadUsage {
  std::uint64_t faults = 0;                ///< page faults, major and minor
  std::uint64_t voluntary_switches = 0;    ///< voluntary context switches
  std::uint64_t involuntary_switches = 0;  ///< involuntary context switches
};
/// Those of the calling thread so far.
ThreadUsage thread_usage() noexcept;

}  // namespace planetree::tools
