#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/session/session.h"

namespace planetree::tools {

/// A session in windows of time. Their number is bounded, whatever its length.
class TouchTimeline {
 public:
  static constexpr std::size_t kMaxWindows = 96;

  /// Ticks after each other.
  struct Window {
    std::size_t first = 0;  ///< number of its first tick
    std::size_t ticks = 0;
    std::size_t degraded = 0;
    std::size_t late = 0;
    std::size_t touching = 0;
    double median_latency_us = 0, max_latency_us = 0;
    double max_width = 0;  ///< of its degraded ticks, model units; may be infinite
  };

  /// period_ns  time between ticks; a tick whose latency is above is late
  TouchTimeline(const std::vector<Tick>& ticks, std::uint64_t period_ns);

  const std::vector<Window>& windows() const { return windows_; }
  /// When the tick is due, from the first one.
  double seconds(std::size_t tick) const {
    return 1e-9 * static_cast<double>(period_ns_) * static_cast<double>(tick);
  }

 private:
  std::uint64_t period_ns_;
  std::vector<Window> windows_;
};

}  // namespace planetree::tools
