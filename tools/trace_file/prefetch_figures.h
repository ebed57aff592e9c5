#pragma once

#include <cstdint>
#include <unordered_set>

#include "planetree/trace.h"

namespace planetree::tools {

/// How good the pages were that were read because a probe moved.
class PrefetchFigures {
 public:
  std::uint64_t read = 0;            ///< pages read for a motion
  std::uint64_t used = 0;            ///< of these: found by a query later
  std::uint64_t evicted_unused = 0;  ///< of these: evicted before a query found them
  std::uint64_t late = 0;            ///< lookups of pages that were just being read for a motion
  /// Pages that a query needed and that were not in memory. A page counts once until it is read,
  /// also if the queries of several ticks miss it.
  std::uint64_t missed = 0;

  /// Adds a record of a trace.
  void add(const PageAccess& access);

  /// Share of the pages read that a query found.
  double accuracy() const noexcept { return share(used, read); }
  /// Share of the pages needed that had been read before.
  double coverage() const noexcept { return share(used, used + missed); }
  /// Share of the pages used that arrived in time.
  double timeliness() const noexcept { return share(used, used + late); }
  /// Share of the pages read that were evicted unused.
  double waste() const noexcept { return share(evicted_unused, read); }

 private:
  static double share(std::uint64_t part, std::uint64_t whole) noexcept {
    return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
  }
  void miss(std::uint32_t page) { missed += missing_.insert(page).second; }

  std::unordered_set<std::uint32_t> missing_;  // missed and not read since
};

}  // namespace planetree::tools
