#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "planetree/trace.h"
#include "planetree/types.h"
#include "tools/trace_file/prefetch_figures.h"
#include "tools/tune/references.h"
#include "tools/tune/trace_timeline.h"

namespace planetree::tools {

/// A call of Probe::motion.
struct RecordedMotion {
  std::uint64_t time_ns;
  Vec3 position, velocity;
};

/// Whether a record is a lookup of a query that counts: not of a fetch thread, nor of Model::open,
/// and if it missed, either the query waits or its answer needed the page.
bool is_counted_lookup(const PageAccess& access) noexcept;

/// What one trace says, from its records in order of time.
class TraceAnalysis {
 public:
  /// Adds a record. Records of Model::open come first.
  void add(const PageAccess& access);

  /// The lookups of queries, and of Model::open before them. Lookups of fetch threads are not
  /// among them: they are how the engine answers misses. Of queries that do not wait, misses are
  /// lookups if the answer needed the page.
  const References& references() const { return references_; }
  /// Queries of all probes, also those that looked up no page.
  std::uint64_t queries() const { return queries_; }
  std::uint64_t degraded() const { return degraded_; }
  /// Lookups that needed a page that was not in memory, as recorded.
  std::uint64_t misses() const { return prefetch_.missed; }
  std::uint64_t evictions() const { return evictions_; }
  /// Different pages that were in memory or looked up.
  std::size_t pages() const { return timeline_.pages(); }
  const PrefetchFigures& prefetch() const { return prefetch_; }
  const TraceTimeline& timeline() const { return timeline_; }
  /// Time of the last record.
  std::uint64_t end_ns() const { return end_ns_; }
  /// The motions of the probe that had most.
  const std::vector<RecordedMotion>& motions() const;

 private:
  void add_lookup(const PageAccess& access);
  void begin_queries(const PageAccess& access);

  References references_;
  PrefetchFigures prefetch_;
  TraceTimeline timeline_;
  std::map<std::uint32_t, std::vector<RecordedMotion>> motions_;  // by probe
  std::map<std::uint32_t, std::uint64_t> next_query_;             // by probe
  std::uint64_t queries_ = 0, degraded_ = 0, evictions_ = 0, end_ns_ = 0;
  bool is_open_ = false;  // Model::open has returned
};

}  // namespace planetree::tools
