#pragma once

#include <span>
#include <string>

#include "planetree/types.h"
#include "tools/session/session.h"

namespace planetree::tools {

/// A session's ticks as CSV: a header, then tick,x,y,z,latency_us,query_us,width,side,status for
/// each; lengths in model units.
std::string touch_ticks(std::span<const Vec3> path, const TouchRecord& record);

}  // namespace planetree::tools
