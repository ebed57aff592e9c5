#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <vector>

#include "planetree/probe.h"
#include "planetree/types.h"
#include "tools/session/real_time.h"

namespace planetree::tools {

/// What became of one tick. Times are from when it was due, so that one that is late shows in
/// those after it.
struct Tick {
  std::uint32_t latency_ns = 0;  ///< from when it was due to the answer
  std::uint32_t query_ns = 0;    ///< the ask alone
  float width = 0;               ///< upper - lower, model units
  Status status = Status::kExact;
  Side side = Side::kUnknown;
};

/// A haptic device's loop: asks where a tip is on its path, at fixed times, without waiting for
/// pages.
struct TouchRecord {
  std::vector<Tick> ticks;
  std::vector<std::uint32_t> floor_ns;  ///< how late a thread woke that did nothing else
  RealTimeRights rights;
  ThreadUsage usage;  ///< of the asking thread, by its ticks
};

/// Runs a session of path.size() ticks, and beside it a thread that is due half a tick later on
/// the same processor and does nothing: how late that is, is the machine's doing.
TouchRecord run_touch_session(Probe& probe, std::span<const Vec3> path,
                              std::chrono::nanoseconds period);

}  // namespace planetree::tools
