#pragma once

#include <span>
#include <string>

#include "planetree/types.h"
#include "tools/session/session.h"

namespace planetree::tools {

/// A session's ticks as CSV: a header and one row per tick with its number, position, latency and
/// query time in microseconds, interval width, side and status. Lengths in model units.
std::string touch_ticks(std::span<const Vec3> path, const TouchRecord& record);

}  // namespace planetree::tools
