#include "tools/session/touch_timeline.h"

#include <algorithm>

#include "tools/session/sorted.h"

namespace planetree::tools {

TouchTimeline::TouchTimeline(const std::vector<Tick>& ticks, std::uint64_t period_ns)
    : period_ns_(period_ns) {
  const std::size_t each = (ticks.size() + kMaxWindows - 1) / kMaxWindows;
  for (std::size_t first = 0; first < ticks.size(); first += each) {
    Window window;
    window.first = first;
    window.ticks = std::min(each, ticks.size() - first);
    std::vector<std::uint32_t> latencies;
    for (std::size_t i = first; i < first + window.ticks; ++i) {
      const Tick& tick = ticks[i];
      latencies.push_back(tick.latency_ns);
      window.late += tick.latency_ns > period_ns;
      window.touching += tick.touches;
      if (tick.status != Status::kDegraded) continue;
      ++window.degraded;
      window.max_width = std::max<double>(window.max_width, tick.width);
    }
    const Sorted<std::uint32_t> sorted(std::move(latencies));
    window.median_latency_us = sorted.at(0.5) / 1e3;
    window.max_latency_us = sorted.at(1) / 1e3;
    windows_.push_back(window);
  }
}

}  // namespace planetree::tools
