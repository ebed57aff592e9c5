#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "planetree/trace.h"
#include "planetree/types.h"
#include "tools/tune/references.h"

namespace planetree::tools {

/// Estimates the page lookups of a trace for another page size, without a file of that size.
///
/// Pages are numbered in the order of their octcodes, so those that follow each other are
/// neighbours. As many as a larger page holds are taken for one. A page of a quarter of the size
/// has about one octant of the cell of a page, because a surface passes through about four of them.
/// A lookup of a smaller page is taken for one of the part of the page that is nearest to the
/// position of the probe, as its last motion told. So queries of probes that do not call
/// Probe::motion always look up the same part.
class PageSizeReplay {
 public:
  /// core_lower, core_upper  of the model, see ModelInfo
  PageSizeReplay(std::uint64_t recorded_bytes, std::uint64_t wanted_bytes, Vec3 core_lower,
                 Vec3 core_upper);

  /// Adds a record; see TraceAnalysis::add().
  void add(const PageAccess& access);

  std::uint64_t page_bytes() const { return page_bytes_; }
  /// The lookups so far. Pages are numbered from 1 in no order; 0 is the root.
  References references() const;

 private:
  /// Section, depth of the recorded page in bits of the Morton code, bits of the other page, and
  /// the recorded page where there may be several of the same cell.
  using Key = std::tuple<std::uint8_t, unsigned, std::uint64_t, std::uint32_t>;

  Key key_of(const PageAccess& access) const;
  std::uint64_t morton_at(const Vec3& position, std::uint64_t page_morton, unsigned bits) const;

  std::uint64_t page_bytes_;
  int more_bits_;                 // of the Morton code of a page; negative for larger pages
  std::uint32_t pages_together_;  // recorded pages of a larger one
  Vec3 core_lower_;
  double cells_per_unit_;                    // finest cells
  std::map<std::uint32_t, Vec3> positions_;  // by probe
  std::map<Key, std::uint32_t> numbers_;
  std::set<std::uint32_t> upper_pages_;                        // recorded pages
  std::set<std::pair<std::uint32_t, std::uint32_t>> made_of_;  // recorded page, number
  References references_;
  bool is_open_ = false;
};

}  // namespace planetree::tools
