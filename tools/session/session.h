#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "planetree/types.h"
#include "tools/session/real_time.h"
#include "tools/session/session_path.h"
#include "tools/session/touch_probe.h"
#include "tools/session/touch_tool.h"

namespace planetree::tools {

/// Result of one tick. Latency counts from the due time, so that a late tick delays later ones too.
struct Tick {
  std::uint32_t latency_ns = 0;  ///< from the due time to the answer
  std::uint32_t query_ns = 0;    ///< time of motion() and query
  float width = 0;               ///< ToolAnswer::width, model units
  Status status = Status::kExact;
  Side side = Side::kUnknown;
  bool touches = false;               ///< ToolAnswer::touches
  InstanceId instance = kNoInstance;  ///< ToolAnswer::instance

  /// The tick of an answer, with latencies of 0.
  static Tick of(const ToolAnswer& answer) {
    return {0,
            0,
            static_cast<float>(answer.width),
            answer.status,
            answer.side,
            answer.touches,
            answer.instance};
  }
};

/// Record of a simulated haptic loop: real-time queries of the tip's position at fixed times.
struct TouchRecord {
  std::vector<Tick> ticks;
  std::vector<std::uint32_t> floor_ns;  ///< how late an idle thread woke, for comparison
  RealTimeRights rights;                ///< of the querying thread
  ThreadUsage usage;                    ///< of the querying thread during its ticks
};

/// Velocity of the tip in model units a second: from the last tick's position to this one's; 0 at
/// the first tick.
Vec3 velocity_at(std::span<const Vec3> path, std::size_t tick,
                 std::chrono::nanoseconds period) noexcept;

/// Runs a session of path.size() ticks. Queries for nearest points have these `parts`. An idle
/// thread is due half a tick later on the same processor. It does nothing, so that its lateness is
/// that of the machine.
///
/// begin_tick  called in the querying thread when a tick is due, before its query; may be empty.
///             The latency of the tick includes its time.
TouchRecord run_touch_session(TouchProbe probe, TouchTool& tool, std::span<const Vec3> path,
                              std::chrono::nanoseconds period, std::uint32_t parts,
                              const TickAction& begin_tick = {});

}  // namespace planetree::tools
