#pragma once

#include <cstdint>

namespace planetree {

/// One look for a page, by an ask of Wait::kNever.
struct PageAccess {
  enum class Kind : std::uint8_t {
    kHit,
    kPrefetched,  ///< the first hit of a page that came because a probe was moving to it
    kMissed,
  };
  std::uint64_t query = 0;  ///< of the probe: its asks of Wait::kNever are 0, 1, 2, ...
  std::uint32_t probe = 0;  ///< probes there at one time have different ones
  std::uint32_t page = 0;
  std::uint8_t level = 0;  ///< of the octree, of the first cell that the page has the tree of
  Kind kind = Kind::kHit;
};

}  // namespace planetree
