#include "planetree/probe.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <new>
#include <utility>

#include "octree/geometry/fp_environment.h"
#include "octree/geometry/strict_math.h"
#include "query/answer/closest_point.h"
#include "query/answer/contact_set.h"
#include "query/answer/query_context.h"
#include "query/answer/side.h"
#include "query/model_state.h"
#include "query/probe_state.h"

namespace planetree::query {

// Leaves a fetch request: a fetch thread runs the query again and waits for the pages.
void ProbeState::request(const Vec3& query, const QueryOptions& options, std::uint32_t parts,
                         std::uint64_t triangles, double radius) noexcept {
  FetchRequest request;
  request.point = query;
  request.max_error = options.max_error;
  request.max_distance = options.max_distance;
  request.max_work = options.max_work;
  request.parts = parts;
  request.side_rule = static_cast<std::uint64_t>(options.side_rule);
  request.normal_rule = static_cast<std::uint64_t>(options.normal_rule);
  request.triangles = triangles;
  request.radius = radius;
  model_.requests(reader_.index()).missed.store(request);
}

template <PageAccess::Query kKind>
ClosestPoint ProbeState::find_closest_point(const Vec3& query,
                                            const QueryOptions& options) noexcept {
  const bool valid = is_valid(query, options);
  ClosestPoint answer = unanswered(valid ? Status::kExact : Status::kBadQuery);
  if (!valid) return answer;
  const QueryOptions limited = with_defaults(options);
  RunningQuery running(*this, kKind, options.wait);
  const bool incomplete = query::closest_point(running.context(), query, limited, answer);
  if (incomplete && running.missed()) request(query, limited, limited.parts);
  side_searches_ += coherence_.searched_side;
  last_parts_ = computed_parts(options.parts);
  last_side_rule_ = options.side_rule;
  if (answer.status == Status::kDegraded)
    note_degraded(answer.upper - answer.lower, running.missed());
  return answer;
}

ClosestPoint ProbeState::closest_point(const Vec3& query, const QueryOptions& options) noexcept {
  if (model_.remote_file && looks_ahead_ && options.wait == Wait::kForPages)
    return find_remote_closest_point(query, options);
  return find_closest_point<PageAccess::Query::kClosestPoint>(query, options);
}

[[gnu::noinline]] ClosestPoint ProbeState::find_remote_closest_point(
    const Vec3& query, const QueryOptions& options) noexcept {
  const WaitLimit limit(*this);
  QueryOptions left = options;
  // After one wait in vain, the query waits for no other page.
  if (!look_ahead(query, options)) left.wait = Wait::kNever;
  return find_closest_point<PageAccess::Query::kClosestPoint>(query, left);
}

[[gnu::noinline]] void ProbeState::note_degraded(double width, bool missed) noexcept {
  model_.count_degraded(missed);
  if (trace_) trace_->degraded(width);
}

// Not inlined, because most calls of contains() end before it and then save few registers.
[[gnu::noinline]] Containment ProbeState::search_side(
    const Vec3& query, const QueryOptions& options, const octree::Point& scaled,
    const octree::SideGrid::Lookup& lookup) noexcept {
  const QueryOptions limited = with_defaults(options);
  RunningQuery running(*this, options.wait);
  const SideResult side = find_containment(running.context(), query, scaled, lookup, limited);
  if (side.status == Status::kDegraded) {
    if (running.missed()) request(query, limited, kSide);
    running.note_degraded();
  }
  return {side.side, side.status};
}

// The side of a sheet is that of its nearest feature, so it takes a search for that.
[[gnu::noinline]] Containment ProbeState::find_front(const Vec3& query,
                                                     QueryOptions options) noexcept {
  options.parts = kSide;
  const ClosestPoint answer = find_closest_point<PageAccess::Query::kContains>(query, options);
  return {answer.side, answer.status};
}

// Without the side layer a solid has no sides, and nothing is searched.
[[gnu::noinline]] Containment ProbeState::leave_unknown(const QueryOptions& options) noexcept {
  last_parts_ = kSide;
  last_side_rule_ = options.side_rule;
  begin_trace(PageAccess::Query::kContains, options.wait);
  note_degraded(std::numeric_limits<double>::infinity(), false);
  return {Side::kUnknown, Status::kDegraded};
}

Containment ProbeState::contains(const Vec3& query, const QueryOptions& options) noexcept {
  if (!is_valid(query, options)) return {};
  const SideMeans means = model_.geometry.side_means(options.side_rule);
  if (means == SideMeans::kFront) return find_front(query, options);
  if (means == SideMeans::kNothing) return leave_unknown(options);
  const octree::Point scaled = model_.geometry.scale.in(query);
  last_parts_ = kSide;
  last_side_rule_ = options.side_rule;
  begin_trace(PageAccess::Query::kContains, options.wait);
  const octree::SideGrid::Lookup lookup =
      look_up_side_grid(model_.geometry, scaled, frames_of(reader_));
  coherence_.side_grid_answered = lookup.winding != octree::SideGrid::kUnknown;
  if (coherence_.side_grid_answered)
    return {lookup.winding != 0 ? Side::kInside : Side::kOutside, Status::kExact};
  return search_side(query, options, scaled, lookup);
}

std::uint32_t ProbeState::fetch_pages(const Vec3& query, const QueryOptions& options,
                                      FetchReason reason, std::span<const Vec3> ahead,
                                      const std::atomic<bool>& stop) noexcept {
  assert(options.wait == Wait::kForPages && options.max_work != QueryOptions::kNoLimit);
  const bool is_prefetch = reason != FetchReason::kMissed;
  if (!is_valid(query, options) ||
      (is_prefetch && model_.cache.frame_count() < kMinFramesToPrefetch &&
       !model_.cache.holds_all_pages()))
    return 0;
  const std::uint32_t early =
      model_.remote_file ? fetch_ahead(query, options, reason, ahead, stop) : 0;
  coherence_.is_on = coherence_.follows_motion = reason == FetchReason::kMotion;
  RunningQuery running(*this,
                       is_prefetch ? PageAccess::Query::kPrefetch : PageAccess::Query::kFetch,
                       options.wait, &stop);
  ClosestPoint unused = unanswered(Status::kExact);
  query::closest_point(running.context(), query, options, unused);
  return early + running.fetched();
}

bool ProbeState::fetch_page(std::uint32_t page, const std::atomic<bool>& stop) noexcept {
  RunningQuery running(*this, PageAccess::Query::kPrefetch, Wait::kForPages, &stop);
  const octree::PageReader& pages = running.pages();
  // A page that is resident already was not looked up by a query, and counts as no hit.
  if (!pages.peek(pages.context, page)) pages.page(pages.context, page);
  return running.fetched() > 0;
}

std::size_t ProbeState::missing_pages(const Vec3& query, const QueryOptions& options,
                                      std::span<std::uint32_t> pages) noexcept {
  assert(options.wait == Wait::kNever);
  if (!is_valid(query, options)) return 0;
  RunningQuery running(*this, PageAccess::Query::kPrefetch, options.wait);
  running.keep_missed(pages);
  ClosestPoint unused = unanswered(Status::kExact);
  query::closest_point(running.context(), query, with_defaults(options), unused);
  return running.kept_missed();
}

ProbeState::Loaded ProbeState::load_page(std::uint32_t page) noexcept {
  RunningQuery running(*this, PageAccess::Query::kPrefetch, Wait::kForPages);
  const octree::PageReader& pages = running.pages();
  if (pages.page(pages.context, page)) return Loaded::kResident;
  return running.missed() ? Loaded::kLate : Loaded::kUnreadable;
}

Found ProbeState::find_triangles(const TriangleSetQuery& query, std::span<ClosestPoint> found,
                                 const QueryOptions& options) noexcept {
  if (!is_valid(query.centre, options) || !(query.radius >= 0)) return {};
  return find_set(query.centre, query.radius, found, options,
                  [&](const QueryContext& context, const QueryOptions& limited) {
                    return query::find_triangles(context, query, limited, found);
                  });
}

Found ProbeState::find_triangles(const Box& box, std::span<ClosestPoint> found,
                                 const QueryOptions& options) noexcept {
  const BoxSetQuery query(box);
  if (!query.is_valid() || !is_valid(query.centre(), options)) return {};
  return find_set(query.centre(), query.radius(), found, options,
                  [&](const QueryContext& context, const QueryOptions& limited) {
                    return query::find_triangles(context, query, limited, found);
                  });
}

// find  find(context, options) finds the triangles, all of which are within the radius
template <class Find>
Found ProbeState::find_set(const Vec3& centre, double radius, std::span<ClosestPoint> found,
                           const QueryOptions& options, const Find& find) noexcept {
  QueryOptions limited = with_defaults(options);
  TriangleSet set;
  std::uint64_t units = 0;
  {
    RunningQuery running(*this, PageAccess::Query::kClosestPoint, options.wait);
    set = find(running.context(), limited);
    units = running.units();
    if (set.is_degraded) {
      if (running.missed()) request(centre, limited, kDistance, found.size(), radius);
      running.note_degraded();
    }
  }
  if ((options.parts & kSide) == 0 || set.found.count == 0) return set.found;
  spend(limited, units);
  const Side side = contains(centre, limited).side;
  for (ClosestPoint& answer : found.first(set.found.count)) {
    answer.side = side;
    if (side == Side::kUnknown) answer.status = Status::kDegraded;
  }
  return set.found;
}

Found ProbeState::find_contacts(const Vec3& query, double radius, std::span<ClosestPoint> found,
                                const QueryOptions& options) noexcept {
  if (!is_valid(query, options) || !(radius >= 0)) return {};
  QueryOptions limited = with_defaults(options);
  RunningQuery running(*this, PageAccess::Query::kClosestPoint, options.wait);
  const ContactSet set = query::find_contacts(running.context(), query, radius, limited,
                                              model_.contact_triangles(reader_.index()), found);
  side_searches_ += coherence_.searched_side;
  last_parts_ = computed_parts(options.parts | kDistance);
  last_side_rule_ = options.side_rule;
  if (!set.is_degraded && !set.nearest_is_incomplete) return set.found;
  limited.max_distance = std::min(limited.max_distance, radius);
  if (running.missed() && set.is_degraded)
    request(query, limited, kDistance, octree::ContactTriangles::kMax, set.reach);
  else if (running.missed())
    request(query, limited, last_parts_);
  if (set.is_degraded)
    running.note_degraded();
  else
    note_degraded(std::numeric_limits<double>::infinity(), running.missed());
  return set.found;
}

void ProbeState::fetch_triangles(const TriangleSetQuery& query, std::uint64_t count,
                                 const QueryOptions& options,
                                 const std::atomic<bool>& stop) noexcept {
  if (!is_valid(query.centre, options) || !(query.radius >= 0)) return;
  RunningQuery running(*this, PageAccess::Query::kFetch, options.wait, &stop);
  visit_triangles(running.context(), query, count, options);
}

}  // namespace planetree::query

namespace planetree {
namespace {

// Not inlined, because most calls of contains() end before it and then save few registers.
[[gnu::noinline]] Containment contains_computed(query::ProbeState& probe, const Vec3& query,
                                                const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  return probe.contains(query, options);
}

}  // namespace

Result<Probe> Probe::create(const Model& model) {
  auto reader = model.state_->claim_reader();
  if (!reader) return reader.error();
  std::unique_ptr<query::BatchBuffers> storage(new (std::nothrow) query::BatchBuffers);
  if (!storage)
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory for a probe; free some and try again");
  return Probe(
      query::ProbeState::create(model.state_->serving(), std::move(*reader), std::move(storage)));
}

Probe::Probe(std::unique_ptr<query::ProbeState> state) noexcept : state_(std::move(state)) {}
Probe::Probe(Probe&&) noexcept = default;
Probe& Probe::operator=(Probe&&) noexcept = default;
Probe::~Probe() = default;

ClosestPoint Probe::closest_point(Vec3 query, const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  return state_->closest_point(query, options);
}

Containment Probe::contains(Vec3 query, const QueryOptions& options) noexcept {
  // Before the FpEnvironmentGuard: reading its register waits for pending computations.
  const Containment fast = state_->contains_fast(query, options);
  return fast.side != Side::kUnknown ? fast : contains_computed(*state_, query, options);
}

Found Probe::nearest_triangles(Vec3 query, std::span<ClosestPoint> found,
                               const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  constexpr double kAnywhere = std::numeric_limits<double>::infinity();
  return state_->find_triangles(query::TriangleSetQuery{query, kAnywhere, false}, found, options);
}

Found Probe::triangles_within(Vec3 query, double radius, std::span<ClosestPoint> found,
                              const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  return state_->find_triangles(query::TriangleSetQuery{query, radius, true}, found, options);
}

Found Probe::triangles_within(const Box& box, std::span<ClosestPoint> found,
                              const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  return state_->find_triangles(box, found, options);
}

Found Probe::contacts(Vec3 query, double radius, std::span<ClosestPoint> found,
                      const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  return state_->find_contacts(query, radius, found, options);
}

void Probe::motion(Vec3 position, Vec3 velocity) noexcept {
  state_->note_motion(position, velocity);
}

std::uint64_t Probe::work_spent() const noexcept { return state_->work_spent(); }

void Probe::contains(std::span<const Vec3> queries, std::span<Containment> answers,
                     const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  query::contains(*state_, queries, answers, options);
}

void Probe::closest_points(std::span<const Vec3> queries, std::span<ClosestPoint> answers,
                           const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  query::closest_points(*state_, queries, answers, options);
}

void Probe::nearest_triangles(std::span<const Vec3> queries, std::span<ClosestPoint> answers,
                              std::span<Found> found, const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  constexpr double kAnywhere = std::numeric_limits<double>::infinity();
  query::find_triangles(*state_, queries, kAnywhere, false, answers, found, options);
}

void Probe::triangles_within(std::span<const Vec3> queries, double radius,
                             std::span<ClosestPoint> answers, std::span<Found> found,
                             const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  query::find_triangles(*state_, queries, radius, true, answers, found, options);
}

void Probe::contacts(std::span<const Vec3> queries, double radius, std::span<ClosestPoint> answers,
                     std::span<Found> found, const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  query::find_contacts(*state_, queries, radius, answers, found, options);
}

}  // namespace planetree
