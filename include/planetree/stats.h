#pragma once

#include <cstdint>

#include "planetree/types.h"

namespace planetree {

/// What a file holds; fixed when it was built.
struct ModelInfo {
  std::uint64_t triangles = 0;        ///< that answer
  std::uint64_t input_triangles = 0;  ///< of the input that could be used, in the region or not
  std::uint64_t skipped = 0;          ///< of bad input records, which do not
  std::uint64_t first_skipped = 0;    ///< index of the first of those, or kNoTriangle
  std::uint64_t vertices = 0;         ///< vertex records of the input
  Vec3 box_lower, box_upper;          ///< of the whole input; model units
  /// Whether only triangles that touch a box were built (`planetree build --box`), from
  /// `region_lower` to `region_upper`, model units. Intervals, sides and the first of equally near
  /// triangles are those of the whole input all the same: nearer to the surface than to the
  /// box's walls answers are exact, elsewhere Status::kDegraded; no walls are the box's sides
  /// that are not within the model's. Beyond a wall, and of a model that is not watertight
  /// wherever there is one, sides are unknown.
  bool has_region = false;
  Vec3 region_lower, region_upper;
  std::uint64_t unbalanced_edges = 0;  ///< along which faces do not balance; see watertight()
  bool float64 = false;                ///< coordinates are doubles that float32 does not hold
  std::uint64_t nodes = 0;             ///< inner nodes of the tree
  std::uint64_t blocks = 0;            ///< leaves: blocks of up to 16 triangles
  std::uint32_t levels = 0;            ///< most nodes between the root and a block
  std::uint32_t pages = 0;
  std::uint32_t page_bytes = 0;  ///< of a page in memory
  std::uint64_t file_bytes = 0;
  struct {
    std::uint64_t headers = 0;
    std::uint64_t page_table = 0;
    std::uint64_t distance_pages = 0;
    std::uint64_t mask_pages = 0;
  } section_bytes;                   ///< adds up to file_bytes
  std::uint64_t content_id[2] = {};  ///< names the pages: equal for equal trees

  /// Whether as many faces run along every edge one way as the other, edges
  /// being the same where their ends are. Sides are told of such models.
  bool watertight() const noexcept { return unbalanced_edges == 0; }
};

/// What an open model has done and holds. Counters since it was opened, of all
/// its probes together.
struct Stats {
  std::uint64_t page_hits = 0;
  std::uint64_t page_misses = 0;
  std::uint64_t pages_read = 0;  ///< from the file
  std::uint64_t pages_evicted = 0;
  std::uint64_t quarantined_pages = 0;  ///< found unreadable or damaged; not tried again
  std::uint64_t waits_given_up = 0;     ///< for pages, at OpenOptions::wait_limit_ms
  std::uint64_t degraded_answers = 0;
  /// Questions of Wait::kNever that lacked pages, and those whose pages were got since. A probe's
  /// newer question takes the place of one that no thread has come to: that is lost.
  std::uint64_t fetch_requests = 0;
  std::uint64_t fetch_requests_served = 0;
  std::uint64_t positions_prefetched = 0;  ///< that probes were moving to
  std::uint64_t page_trace_dropped = 0;    ///< see Model::drain_page_trace
  std::uint64_t frames = 0;                ///< most pages in memory at once
  std::uint64_t arena_bytes = 0;           ///< memory of those
  std::uint64_t table_bytes = 0;           ///< all else: page map, probes, colour map, scratch, ...
  std::uint64_t budget_bytes = 0;          ///< as asked; arena and tables stay within it
  std::uint64_t locked_bytes = 0;    ///< of the arena, and of what else is asked without waiting
  bool header_copy_damaged = false;  ///< one of the file's two headers; copy the file anew
};

}  // namespace planetree
