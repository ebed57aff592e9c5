#pragma once

#include <cstdint>

namespace planetree {

/// One page lookup of a real-time query (Wait::kNever). See Model::drain_page_trace.
struct PageAccess {
  /// Result of a lookup.
  enum class Kind : std::uint8_t {
    kHit,         ///< the page was resident
    kPrefetched,  ///< first hit of a page that was fetched because a probe moved towards it
    kMissed,      ///< the page was not resident
  };
  /// Number of the query: real-time queries of one probe index are numbered 0, 1, 2, ...
  std::uint64_t query = 0;
  /// Index of the probe. Probes that exist at the same time have different ones; a new probe may
  /// have the index of a destroyed one and continues its numbers.
  std::uint32_t probe = 0;
  std::uint32_t page = 0;  ///< page number, below ModelInfo::pages
  std::uint8_t level = 0;  ///< octree level of the octcode in the page's key, 0 to 19
  Kind kind = Kind::kHit;  ///< result of the lookup
};

}  // namespace planetree
