#pragma once

#include <span>
#include <string>

#include "planetree/types.h"
#include "tools/session/touch_outcome.h"

namespace planetree::tools {

/// A session's ticks as CSV: a header and one row per tick with its number, position, latency and
/// query time in microseconds, interval width, side and status; in a scene also the position of the
/// instance in the scene file, empty if there is none. Lengths in model units.
std::string touch_ticks(std::span<const Vec3> path, const TouchOutcome& outcome);

}  // namespace planetree::tools
