#pragma once

#include <cstdint>

#include "planetree/types.h"

namespace planetree {

/// Contents of a file, fixed when it was built. Lengths and positions are in model units.
struct ModelInfo {
  std::uint64_t triangles = 0;        ///< triangles in the file, which answers name
  std::uint64_t input_triangles = 0;  ///< usable triangles of the input, in the region or not
  std::uint64_t skipped = 0;          ///< triangle indices that skipped input records take
  std::uint64_t first_skipped = 0;    ///< the least of those indices, or kNoTriangle
  std::uint64_t vertices = 0;         ///< vertex records of the input
  Vec3 box_lower,                     ///< least corner of the whole input's box
      box_upper;                      ///< greatest corner of the whole input's box
  /// Whether the file holds only the triangles that touch a region, which is a box (`planetree
  /// build --box`). Intervals, sides and the choice among equally near triangles are nevertheless
  /// those of the whole input. A wall is a side of the region that lies within the model's box.
  /// Answers are exact where the surface is nearer than every wall, and Status::kDegraded
  /// elsewhere. Sides are unknown beyond a wall. If there is a wall and the model is not
  /// watertight, they are unknown everywhere.
  bool has_region = false;
  Vec3 region_lower,                   ///< least corner of the region
      region_upper;                    ///< greatest corner of the region
  std::uint64_t unbalanced_edges = 0;  ///< edges that more faces run along one way than the other
  bool float64 = false;                ///< whether coordinates are doubles that no float holds
  std::uint64_t nodes = 0;             ///< inner nodes of the tree
  std::uint64_t blocks = 0;            ///< leaves of the tree: blocks of up to 16 triangles
  std::uint32_t levels = 0;            ///< maximum number of nodes on a path from root to block
  std::uint32_t pages = 0;             ///< distance and mask pages; numbers go from 0
  std::uint32_t page_bytes = 0;        ///< capacity of a page in memory; a power of two
  std::uint64_t file_bytes = 0;        ///< length of the file
  /// Stored bytes of each section of the file; adds up to `file_bytes`.
  struct {
    std::uint64_t headers = 0;         ///< header and its copy
    std::uint64_t page_table = 0;      ///< page table
    std::uint64_t distance_pages = 0;  ///< pages of the tree
    std::uint64_t mask_pages = 0;      ///< pages of the mask
  } section_bytes;                     ///< stored bytes of each section
  std::uint64_t content_id[2] = {};    ///< hash over all page hashes: equal for equal trees

  /// Whether as many faces run along every edge one way as the other, where edges with equal ends
  /// are one edge. The winding number is then a whole number.
  bool watertight() const noexcept { return unbalanced_edges == 0; }
};

/// State and counters of an open model. Counters begin when it is opened and cover all of its
/// probes and threads. Taken while other threads work, they need not agree with each other.
struct Stats {
  std::uint64_t page_hits = 0;          ///< page lookups that found the page in memory
  std::uint64_t page_misses = 0;        ///< page lookups that did not
  std::uint64_t pages_read = 0;         ///< pages read from the file and decoded
  std::uint64_t pages_evicted = 0;      ///< pages removed from memory for others
  std::uint64_t quarantined_pages = 0;  ///< pages found unreadable or damaged; not tried again
  std::uint64_t waits_given_up = 0;     ///< waits that OpenOptions::wait_limit_ms ended
  std::uint64_t degraded_answers = 0;   ///< answers of Status::kDegraded
  /// Fetch requests: real-time queries (Wait::kNever) that lacked pages. A newer request of a probe
  /// replaces one that no fetch thread has taken yet; the replaced one is never served.
  std::uint64_t fetch_requests = 0;
  std::uint64_t fetch_requests_served = 0;  ///< fetch requests that a fetch thread has served
  std::uint64_t positions_prefetched = 0;   ///< positions ahead of moving probes, prefetched
  std::uint64_t page_trace_dropped = 0;     ///< accesses that found a probe's page trace full
  std::uint64_t frames = 0;                 ///< maximum number of pages in memory at one time
  std::uint64_t arena_bytes = 0;            ///< memory of the frames
  std::uint64_t table_bytes = 0;            ///< all other memory: tables, probes, side grid, ...
  std::uint64_t budget_bytes = 0;           ///< memory_budget_bytes; at least the two above
  std::uint64_t locked_bytes = 0;           ///< locked memory: frames, cache tables, query arena
  /// One of the file's two headers is damaged and the other one is in use: copy the file anew.
  bool header_copy_damaged = false;
};

}  // namespace planetree
