#pragma once

#include <cstdint>

#include "planetree/attributes.h"
#include "planetree/layers.h"
#include "planetree/types.h"

namespace planetree {

/// Contents of a file, fixed when it was built. Lengths and positions are in model units.
struct ModelInfo {
  std::uint64_t triangles = 0;        ///< number of triangles in the file
  std::uint64_t input_triangles = 0;  ///< usable triangles of the whole input
  std::uint64_t skipped = 0;          ///< number of triangle indices of skipped records
  std::uint64_t first_skipped = 0;    ///< the lowest of these indices, or kNoTriangle
  std::uint64_t vertices = 0;         ///< vertex records of the input
  Vec3 box_lower,                     ///< lower corner of the whole input's box
      box_upper;                      ///< upper corner of the whole input's box
  Vec3 core_lower,  ///< lower corner of the core: the box of all triangles but the strays
      core_upper;   ///< upper corner of the core
  /// Number of stray triangles of the whole input. These are few, at most one in 64, and so far
  /// from all others that the box is more than four times as long as the core. 0: the core is the
  /// box.
  std::uint64_t strays = 0;
  /// Whether the file has only the triangles that touch a region, which is a box (`planetree
  /// build --box`). A wall is a face of the region that lies within the model's box.
  ///
  /// Every interval, and every side that is known, is right for the whole input. An answer is exact
  /// if the surface is nearer to the query point than every wall. It is then the answer for the
  /// whole input. Otherwise it is not exact. By SideRule::kSolid sides are unknown beyond a wall.
  /// By SideRule::kSurface a side is known if the nearest triangle is.
  bool has_region = false;
  Vec3 region_lower,                   ///< lower corner of the region
      region_upper;                    ///< upper corner of the region
  std::uint64_t unbalanced_edges = 0;  ///< edges that are not balanced, see watertight()
  /// Number of caps: triangles that close the surface, for finding sides. They are no part of the
  /// surface: no distance, point, normal or index is of a cap. A file without the side layer has
  /// none.
  std::uint64_t caps = 0;
  double cap_area = 0;  ///< sum of the caps' areas, square units
  /// How sides are decided by default: SideRule::kSolid or kSurface. An open surface of an openness
  /// of 0.375 or more is taken for a sheet, unless BuildOptions::side says otherwise.
  SideRule side_rule = SideRule::kSolid;
  bool side_is_chosen = false;  ///< whether BuildOptions::side chose the rule
  /// How open the surface of the input is: the length of the sum of the triangles' area vectors,
  /// divided by the sum of their areas, without strays. 0 if closed, 1 for a flat sheet.
  double openness = 0;
  bool float64 = false;               ///< whether coordinates are doubles; not all fit a float
  std::uint64_t nodes = 0;            ///< inner nodes of the tree
  std::uint64_t blocks = 0;           ///< leaves of the tree: blocks of up to 16 triangles
  std::uint32_t levels = 0;           ///< height of the tree, in nodes
  std::uint32_t layers = kAllLayers;  ///< layers of the file, as BuildOptions::layers
  /// Attributes that the file keeps of its triangles, as BuildOptions::keep; 0: none.
  std::uint32_t attributes = 0;
  ValueKind value_kind = ValueKind::kUnsigned;  ///< type of MeshTriangle::value, with kKeepValue
  std::uint32_t pages = 0;                      ///< pages of all parts; numbers go from 0
  std::uint32_t page_bytes = 0;                 ///< maximum bytes of a decoded page; a power of two
  std::uint64_t file_bytes = 0;                 ///< length of the file
  /// Stored bytes of each part of the file. They add up to `file_bytes`.
  struct {
    std::uint64_t headers = 0;          ///< header and its copy
    std::uint64_t directory = 0;        ///< where the pages are, and their hashes
    std::uint64_t distance_pages = 0;   ///< pages of the tree
    std::uint64_t cap_pages = 0;        ///< pages of the caps that close the surface
    std::uint64_t field_pages = 0;      ///< pages of the coarse field
    std::uint64_t attribute_pages = 0;  ///< pages of the attributes of triangles
    std::uint64_t mask_pages = 0;       ///< pages of the mask
    std::uint64_t extensions = 0;       ///< metadata and other bytes with a name
  } section_bytes;                      ///< stored bytes of each part
  std::uint64_t content_id[2] = {};     ///< hash over the hashes of all pages, low word first

  /// Whether every edge of the input is balanced: as many triangles traverse it in one direction as
  /// in the other. Edges whose ends have equal positions are one edge. Winding numbers are then
  /// integers.
  bool watertight() const noexcept { return unbalanced_edges == 0; }
};

/// State and counters of an open model. Counters start at 0 when the model is opened, are never
/// reset, and cover all its probes, batches and threads. While other threads run queries, the
/// counters are not a consistent snapshot.
struct Stats {
  std::uint64_t page_hits = 0;          ///< page lookups that found the page in memory
  std::uint64_t page_misses = 0;        ///< page lookups that did not
  std::uint64_t pages_read = 0;         ///< pages read from the file and decoded
  std::uint64_t pages_evicted = 0;      ///< pages evicted to make room for others
  std::uint64_t quarantined_pages = 0;  ///< pages found unreadable or damaged; never read again
  /// Waits that OpenOptions::wait_limit_ms ended, and reads that the server of a URL did not
  /// answer.
  std::uint64_t waits_given_up = 0;
  std::uint64_t degraded_answers = 0;  ///< answers of Status::kDegraded
  /// Of these, answers of queries that lacked no page: QueryOptions::max_work was spent, a wall of
  /// the region is nearer than the surface, the winding number is 1/2 to the last bits, or the
  /// model has no side layer.
  std::uint64_t degraded_without_misses = 0;
  /// Fetch requests: queries whose answers lacked pages. Most are real-time queries. The others are
  /// blocking queries that reached the wait limit. A newer request of a probe replaces an older one
  /// that no fetch thread has taken yet. The older one is never served.
  std::uint64_t fetch_requests = 0;
  std::uint64_t fetch_requests_served = 0;  ///< fetch requests that a fetch thread has served
  std::uint64_t pages_prefetched = 0;       ///< pages read because of Probe::motion
  std::uint64_t pages_read_ahead = 0;       ///< pages read because of OpenOptions::read_ahead
  /// Of a model opened by URL: requests sent, repeated ones included. This and the next three are 0
  /// for a file.
  std::uint64_t http_requests = 0;
  std::uint64_t http_bytes = 0;         ///< bytes that came from the server
  std::uint64_t http_cached_bytes = 0;  ///< bytes that OpenOptions::http_cache had instead
  /// Of a model opened by URL: round trips that had to follow each other. Requests that were on the
  /// way at once count as one. Times the latency of the server, the time that requests took at
  /// least.
  std::uint64_t http_rounds = 0;
  std::uint64_t page_trace_dropped = 0;   ///< records lost because a page trace was full
  std::uint32_t layers = kDistanceLayer;  ///< layers that are open; see OpenOptions::layers
  std::uint64_t frames = 0;               ///< frames: maximum number of pages in memory
  std::uint64_t arena_bytes = 0;          ///< memory of the frames, not of the whole arena
  std::uint64_t table_bytes = 0;          ///< all other memory: tables, query arena, buffers
  std::uint64_t budget_bytes = 0;         ///< memory_budget_bytes; at least the sum of both above
  std::uint64_t locked_bytes = 0;         ///< locked memory: frames, cache tables, query arena
  /// Whether one of the two headers of the file is damaged. The model uses the other one. Restore
  /// the file from a copy or build it again.
  bool header_copy_damaged = false;
  /// Whether a page of the coarse field is damaged or unreadable. The model then does without the
  /// field: answers within an error take more time, and degraded answers are less narrow.
  bool field_damaged = false;
};

}  // namespace planetree
