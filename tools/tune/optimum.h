#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/tune/references.h"

namespace planetree::tools {

/// Misses of Belady's optimum for each number of frames: when a frame is needed, the page is
/// evicted whose next lookup is the last. No policy that reads pages when they miss has fewer
/// misses. One of the frames is the root's.
///
/// Takes 8 bytes for each stored lookup.
///
/// frames  each at least 2
std::vector<std::uint64_t> optimum_misses(const References& references,
                                          std::span<const std::uint32_t> frames);

}  // namespace planetree::tools
