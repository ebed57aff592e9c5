#pragma once

#include <cstdint>

namespace planetree {

/// One page lookup of a real-time query (Wait::kNever). See Model::drain_page_trace.
struct PageAccess {
  /// Result of a lookup.
  enum class Kind : std::uint8_t {
    kHit,         ///< the page was in memory
    kPrefetched,  ///< first hit of a page that was fetched because of Probe::motion
    kMissed,      ///< the page was not in memory
  };
  /// Sequence number of the real-time query. Each value of `probe` has a sequence of its own, which
  /// starts at 0.
  std::uint64_t query = 0;
  /// Index of the probe. Probes that exist at the same time have different indices. A new probe may
  /// have the index of a destroyed one. The sequence of query numbers then continues.
  std::uint32_t probe = 0;
  std::uint32_t page = 0;  ///< page number, below ModelInfo::pages
  std::uint8_t level = 0;  ///< octree level of the page: 0 is the whole model, 19 a finest cell
  Kind kind = Kind::kHit;  ///< result of the lookup
};

}  // namespace planetree
