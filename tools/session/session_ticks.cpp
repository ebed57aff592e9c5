#include "tools/session/session_ticks.h"

#include <fmt/format.h>

#include <cassert>
#include <cstddef>
#include <iterator>

#include "tools/answers/answer_words.h"

namespace planetree::tools {

std::string touch_ticks(std::span<const Vec3> path, const TouchRecord& record) {
  assert(path.size() == record.ticks.size());
  std::string text = "tick,x,y,z,latency_us,query_us,width,side,status\n";
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Tick& tick = record.ticks[i];
    fmt::format_to(std::back_inserter(text),
                   "{},{:.17g},{:.17g},{:.17g},{:.3f},{:.3f},{:.9g},{},{}\n", i, path[i].x,
                   path[i].y, path[i].z, tick.latency_ns / 1e3, tick.query_ns / 1e3, tick.width,
                   side_word(tick.side), status_word(tick.status));
  }
  return text;
}

}  // namespace planetree::tools
