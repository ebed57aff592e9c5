#include "query/probe_state.h"

#include <cassert>

#include "octree/geometry/strict_math.h"
#include "query/answer/closest_point.h"
#include "query/answer/containment.h"
#include "query/answer/query_rules.h"
#include "query/serve/page_accessor.h"

namespace planetree::query {

// Leaves a fetch request: a fetch thread runs the query again and waits for the pages.
void ProbeState::request(const Vec3& query, const QueryOptions& options,
                         std::uint32_t parts) noexcept {
  model_.requests(reader_.index())
      .missed.store({query, options.max_error, options.max_distance, options.max_work, parts});
}

ClosestPoint ProbeState::closest_point(const Vec3& query, const QueryOptions& options) noexcept {
  const bool valid = is_valid(query, options);
  ClosestPoint answer = unanswered(valid ? Status::kExact : Status::kBadQuery);
  if (!valid) return answer;
  const QueryOptions limited = with_defaults(options);
  PageAccessor accessor(reader_, options.wait, model_.query_terms);
  accessor.set_trace(trace_.begin_query(options.wait));
  const bool incomplete =
      query::closest_point({model_.geometry, accessor.pages(), coherence_}, query, limited, answer);
  if (incomplete && accessor.missed()) request(query, limited, limited.parts);
  last_parts_ = computed_parts(options.parts);
  if (answer.status == Status::kDegraded) model_.degraded.fetch_add(1, std::memory_order_relaxed);
  return answer;
}

// Not inlined, because most calls of contains() end before it and then save few registers.
[[gnu::noinline]] Containment ProbeState::search_side(const Vec3& query,
                                                      const QueryOptions& options,
                                                      const octree::Point& scaled,
                                                      const octree::SideGrid::Lookup& lookup,
                                                      PageTraceWriter* trace) noexcept {
  const QueryOptions limited = with_defaults(options);
  PageAccessor accessor(reader_, options.wait, model_.query_terms);
  accessor.set_trace(trace);
  const SideResult side = find_containment({model_.geometry, accessor.pages(), coherence_}, query,
                                           scaled, lookup, limited);
  if (side.status == Status::kDegraded) {
    if (accessor.missed()) request(query, limited, kSide);
    model_.degraded.fetch_add(1, std::memory_order_relaxed);
  }
  return {side.side, side.status};
}

Containment ProbeState::contains(const Vec3& query, const QueryOptions& options) noexcept {
  if (!is_valid(query, options)) return {};
  const octree::Point scaled = model_.geometry.scale.in(query);
  last_parts_ = kSide;
  PageTraceWriter* const trace = trace_.begin_query(options.wait);
  const octree::SideGrid::Lookup lookup =
      look_up_side_grid(model_.geometry, scaled, frames_of(reader_));
  coherence_.side_grid_answered = lookup.winding != octree::SideGrid::kUnknown;
  if (coherence_.side_grid_answered)
    return {lookup.winding != 0 ? Side::kInside : Side::kOutside, Status::kExact};
  return search_side(query, options, scaled, lookup, trace);
}

void ProbeState::fetch_pages(const Vec3& query, const QueryOptions& options, bool is_prefetch,
                             const std::atomic<bool>& stop) noexcept {
  assert(options.wait == Wait::kForPages && options.max_work != QueryOptions::kNoLimit);
  if (!is_valid(query, options)) return;
  trace_.set_prefetching(is_prefetch);
  PageAccessor accessor(reader_, options.wait, model_.fetcher_terms, &stop);
  accessor.set_trace(trace_.begin_query(options.wait));
  ClosestPoint unused = unanswered(Status::kExact);
  query::closest_point({model_.geometry, accessor.pages(), coherence_}, query, options, unused);
  trace_.set_prefetching(false);
}

}  // namespace planetree::query
