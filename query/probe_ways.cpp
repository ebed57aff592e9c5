#include <algorithm>
#include <array>
#include <limits>

#include "octree/geometry/fp_environment.h"
#include "octree/geometry/strict_math.h"
#include "planetree/probe.h"
#include "query/answer/first_contact.h"
#include "query/answer/line_hits.h"
#include "query/probe_state.h"

/// Queries along a way: rays and moving balls.
namespace planetree::query {
namespace {

// A search by a fetch thread stops after so many triangles at a time.
constexpr std::size_t kMaxHitsToFetch = 32;

}  // namespace

// Leaves a fetch request for a way up to a position, and notes that the answer lacks pages.
void ProbeState::note_missing_way(const ModelLine& way, double end, double radius,
                                  std::uint64_t count, const QueryOptions& options,
                                  RunningQuery& running) noexcept {
  const Scale& scale = model_.geometry.scale;
  if (running.missed() && !way.is_far()) {
    const octree::TreeInfo& tree = model_.geometry.tree;
    const octree::LineRange range = way.within(tree.box_lower, tree.box_upper, scale.in(radius));
    FetchRequest request;
    request.point = scale.out(way.at(range.lower));
    request.to = scale.out(way.at(std::min(end, range.upper)));
    request.max_distance = std::numeric_limits<double>::infinity();
    request.max_work = options.max_work;
    request.parts = kDistance;
    request.triangles = count;
    request.radius = radius;
    request.is_way = 1;
    model_.requests(reader_.index()).missed.store(request);
  }
  running.note_degraded();
}

FirstHit ProbeState::find_first_hit(const Ray& ray, const QueryOptions& options) noexcept {
  if (!is_valid(ray.origin, options) || !is_valid(ray)) return {};
  const QueryOptions limited = with_defaults(options);
  const ModelLine way(model_.geometry.scale, ray);
  RunningQuery running(*this, PageAccess::Query::kClosestPoint, options.wait);
  const FirstHit first = query::first_hit(running.context(), way, limited);
  if (first.is_degraded) note_missing_way(way, way.range().upper, 0, 1, limited, running);
  return first;
}

Found ProbeState::all_hits(const Ray& ray, std::span<RayHit> hits,
                           const QueryOptions& options) noexcept {
  if (!is_valid(ray.origin, options) || !is_valid(ray)) return {};
  const QueryOptions limited = with_defaults(options);
  ModelLine way(model_.geometry.scale, ray);
  way.end_after(model_.geometry.scale.in(options.max_distance));
  RunningQuery running(*this, PageAccess::Query::kClosestPoint, options.wait);
  const LineHits found = find_hits(running.context(), way, true, limited, hits);
  if (found.is_degraded) note_missing_way(way, way.range().upper, 0, hits.size(), limited, running);
  return found.found;
}

FirstContact ProbeState::first_contact(const Sweep& sweep, const QueryOptions& options) noexcept {
  FirstContact answer;
  if (!is_valid(sweep.from, options) || !is_valid(sweep)) return answer;
  const QueryOptions limited = with_defaults(options);
  RunningQuery running(*this, PageAccess::Query::kClosestPoint, options.wait);
  bool is_degraded = false;
  answer = query::first_contact(running.context(), sweep, limited, is_degraded);
  if (is_degraded)
    note_missing_way(ModelLine(model_.geometry.scale, sweep), 1, sweep.radius, 1, limited, running);
  return answer;
}

void ProbeState::fetch_way(const Sweep& way, std::uint64_t count, const QueryOptions& options,
                           const std::atomic<bool>& stop) noexcept {
  if (!is_valid(way.from, options) || !is_valid(way)) return;
  RunningQuery running(*this, PageAccess::Query::kFetch, options.wait, &stop);
  const QueryContext context = running.context();
  if (count == 1) {
    bool is_degraded = false;
    query::first_contact(context, way, options, is_degraded);
    return;
  }
  std::array<RayHit, kMaxHitsToFetch> hits;
  const std::size_t kept = std::min<std::size_t>(count, hits.size());
  find_hits(context, ModelLine(model_.geometry.scale, way), count > hits.size(), options,
            std::span(hits).first(kept));
}

}  // namespace planetree::query

namespace planetree {

RayHit Probe::first_hit(const Ray& ray, const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  return state_->first_hit(ray, options);
}

Found Probe::all_hits(const Ray& ray, std::span<RayHit> hits,
                      const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  return state_->all_hits(ray, hits, options);
}

FirstContact Probe::first_contact(const Sweep& sweep, const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  return state_->first_contact(sweep, options);
}

void Probe::first_hits(std::span<const Ray> rays, std::span<RayHit> hits,
                       const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  query::first_hits(*state_, rays, hits, options);
}

void Probe::first_contacts(std::span<const Sweep> sweeps, std::span<FirstContact> contacts,
                           const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  query::first_contacts(*state_, sweeps, contacts, options);
}

}  // namespace planetree
