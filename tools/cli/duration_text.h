#pragma once

#include <cstdint>
#include <string_view>

#include "planetree/error.h"

namespace planetree::tools {

/// Reads a time such as 85us, 1.5ms or 2s, in nanoseconds. At most 10 s.
///
/// errors  kBadArgument
Result<std::uint64_t> parse_latency(std::string_view text);

}  // namespace planetree::tools
