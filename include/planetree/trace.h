#pragma once

#include <cstdint>

#include "planetree/types.h"

namespace planetree {

/// One record of a page trace: a page lookup, a page read or evicted, a degraded answer, or a
/// motion. See Model::drain_page_trace.
struct PageAccess {
  /// What happened.
  enum class Event : std::uint8_t {
    kHit,            ///< a query found the page in memory
    kPrefetched,     ///< the same; it is the first hit since the page was read for a motion
    kMissed,         ///< a query did not find the page and went on without it
    kLate,           ///< the same, while the page was being read for a motion
    kFetched,        ///< a query did not find the page and waits for it: its read begins
    kInstalled,      ///< the page has been read and is in memory from now on
    kEvicted,        ///< the page is no longer in memory
    kEvictedUnused,  ///< the same; it was read for a motion, and no query has found it since
    kDegraded,       ///< the answer of the query is Status::kDegraded; no page
    kMotion,         ///< Probe::motion was called; no page
  };
  /// The query that looked the page up or waits for it. Fetch threads make queries too.
  enum class Query : std::uint8_t {
    kClosestPoint,  ///< Probe::closest_point, closest_points or a search for triangles
    kContains,      ///< Probe::contains
    kFetch,         ///< of a fetch thread, for a query that lacked pages or waits for them
    kPrefetch,      ///< of a fetch thread, for a motion
    kOpen,          ///< of Model::open
  };
  /// Part of the file that has the page.
  enum class Section : std::uint8_t {
    kTree,        ///< pages of the tree
    kCaps,        ///< pages of the caps that close the surface
    kField,       ///< pages of the coarse field; these are read at open and have no records
    kMask,        ///< pages of the mask, which tells sides
    kAttributes,  ///< pages of the attributes of triangles
  };

  /// Time in nanoseconds since the model was opened. Each kInstalled and kEvicted has a time of its
  /// own. A query has one time for its lookups: that of the last event, or of the last look of a
  /// fetch thread for work, before the query. Sorted by time, stably, records of different probes
  /// are in the order in which they happened, except for queries that ran while a page was read.
  std::uint64_t time_ns = 0;
  /// Sequence number of the query. Each value of `probe` has a sequence of its own, which starts at
  /// 0. Queries that look up no page count too. For kMotion: number of the next query.
  std::uint64_t query = 0;
  /// Octree cell of the page, as in the file: see format-spec/v1/spec.md. 0 without a page.
  std::uint64_t octcode = 0;
  /// Index of the probe. Probes that exist at the same time have different indices. A new probe may
  /// have the index of a destroyed one. The sequence of query numbers then continues. Fetch threads
  /// and batch threads have probes too.
  std::uint32_t probe = 0;
  std::uint32_t page = 0;          ///< page number, below ModelInfo::pages; 0 without a page
  std::uint32_t stored_bytes = 0;  ///< size of the page in the file; in memory: page_bytes
  /// For kDegraded: upper - lower of the answer, model units, rounded to float; infinity for
  /// Probe::contains.
  float width = 0;
  Event event = Event::kHit;                ///< what happened
  Query query_kind = Query::kClosestPoint;  ///< kind of the query that the record is of
  Section section = Section::kTree;         ///< part of the file that has the page
  std::uint8_t level = 0;  ///< octree level of the page: 0 is the whole model, 19 a finest cell
  bool in_batch = false;   ///< the query is one of a batch
  bool waits = false;      ///< the query waits for pages (Wait::kForPages)
  /// For kMissed and kLate: the page could have changed the answer, which is degraded for lack of
  /// it. False: something nearer was found elsewhere, or the part that looked the page up was found
  /// without it. True for kFetched.
  bool needed = false;
  bool is_upper = false;  ///< for kInstalled: the page links to other pages
  Vec3 position;          ///< for kMotion, model units
  Vec3 velocity;          ///< for kMotion, model units per second
};

}  // namespace planetree
