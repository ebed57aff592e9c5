#include "tools/session/session_ticks.h"

#include <fmt/format.h>

#include <cassert>
#include <cstddef>
#include <iterator>

#include "tools/answers/answer_words.h"
#include "tools/session/touch_instances.h"

namespace planetree::tools {

std::string touch_ticks(std::span<const Vec3> path, const TouchOutcome& outcome) {
  const TouchRecord& record = outcome.record;
  assert(path.size() == record.ticks.size());
  const bool is_scene = !outcome.instances.empty();
  std::string text = "tick,x,y,z,latency_us,query_us,width,side,status";
  text += is_scene ? ",instance\n" : "\n";
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Tick& tick = record.ticks[i];
    fmt::format_to(std::back_inserter(text),
                   "{},{:.17g},{:.17g},{:.17g},{:.3f},{:.3f},{:.9g},{},{}", i, path[i].x, path[i].y,
                   path[i].z, tick.latency_ns / 1e3, tick.query_ns / 1e3, tick.width,
                   side_word(tick.side), status_word(tick.status));
    const std::size_t position = position_of(tick.instance, outcome.instances);
    if (is_scene) text += ',';
    if (position < outcome.instances.size()) text += std::to_string(position);
    text += '\n';
  }
  return text;
}

}  // namespace planetree::tools
