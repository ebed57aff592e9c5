#include "query/scene/ray_search.h"

#include <algorithm>
#include <cmath>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "octree/nearest/interval_ends.h"
#include "query/answer/query_context.h"
#include "query/scene/scene_model.h"
#include "query/shell/vectors.h"

namespace planetree::query {
namespace {

// Rounding of a position of the ray, as a share of the lengths of its ends and its origin: a
// product and a sum err by u each.
constexpr double kRayRounding = 0x1p-51;
// Rounding of a direction that is the difference of two points, and of a t between two others.
constexpr double kDifferenceRounding = 0x1p-51;

RayHit nothing_before(double t, Status status) {
  RayHit hit;
  hit.t_lower = t;
  hit.status = status;
  return hit;
}

double between(const octree::LineRange& range, double share) {
  return range.lower + share * (range.upper - range.lower);
}
double rounding_in(const octree::LineRange& range) { return kDifferenceRounding * range.upper; }

}  // namespace

bool SceneProbeState::RaySearch::can_turn(const Vec3& direction) noexcept {
  const double most =
      std::max({std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)});
  return most >= 0x1p-400 && most <= 0x1p400;
}

SceneProbeState::RaySearch::RaySearch(SceneProbeState& scene, const Ray& ray,
                                      const QueryOptions& options) noexcept
    : scene_(scene),
      view_(scene.view_),
      ray_(ray),
      speed_(upper_length(ray.direction)),
      end_(std::min(ray.t_max, ray.t_min + options.max_distance / speed_)),
      options_(with_defaults(options)) {}

SceneRayHit SceneProbeState::RaySearch::run() noexcept {
  // An only instance is asked, so that the scene answers as its model does.
  if (view_.size() == 1) {
    visit(0);
    return finish();
  }
  view_.compute_entries(ray_);
  for (std::size_t index = view_.nearest(); index < view_.size(); index = view_.nearest()) {
    const double entry = view_.entry(index);
    if (entry > end_) first_.end_at(end_);
    if (entry > std::min(first_.best().t, end_)) break;
    view_.mark_visited(index);
    visit(index);
  }
  return finish();
}

void SceneProbeState::RaySearch::visit(std::size_t index) noexcept {
  first_.offer(view_.is_placed(index) ? ask(index) : nothing_before(ray_.t_min, Status::kDegraded),
               view_.id(index));
}

RayHit SceneProbeState::RaySearch::ask(std::size_t index) noexcept {
  const octree::RigidTransform transform = view_.transform(index);
  if (!transform.is_identity()) return ask_moved(index, transform);
  Ray ray = ray_;
  ray.t_max = std::min(ray.t_max, first_.upper());
  ProbeState& probe = scene_.probe(index);
  return spending(probe, options_, [&] { return probe.first_hit(ray, options_); });
}

RayHit SceneProbeState::RaySearch::ask_moved(std::size_t index,
                                             const octree::RigidTransform& transform) noexcept {
  const octree::LineRange range = view_.range_in_box(index, ray_);
  const double wanted = std::min(end_, first_.upper());
  const bool is_beyond = range.upper > end_ && wanted == end_;
  const RayHit nothing = nothing_before(range.upper > wanted ? wanted : kInfinity,
                                        is_beyond ? Status::kBeyondMaxDistance : Status::kExact);
  if (range.lower > std::min(range.upper, wanted)) return nothing;
  LocalRay local;
  if (!find_local(transform, range, wanted, local))
    return nothing_before(ray_.t_min, Status::kDegraded);
  ProbeState& probe = scene_.probe(index);
  QueryOptions options = options_;
  options.max_distance = local.length;
  const FirstContact contact =
      spending(probe, options_, [&] { return probe.first_contact(local.way, options); });
  if (contact.free || contact.status == Status::kBeyondMaxDistance) return nothing;
  RayHit hit = find_hit(probe, local);
  if (contact.status != Status::kExact) hit.status = Status::kDegraded;
  const double lower = between(range, std::min(contact.t_lower, 1.0));
  hit.t_lower = std::max(range.lower, lower - rounding_in(range));
  if (!(hit.t < kInfinity)) {
    if (is_beyond && hit.status == Status::kExact) hit.status = Status::kBeyondMaxDistance;
    return hit;
  }
  hit.point = transform.apply(hit.point);
  hit.normal = transform.rotate(hit.normal);
  return hit;
}

// The ends of the local ray are those of the range, wherever the hits of others end it, so that an
// answer does not depend on them. Returns false if the ends are out of the range of poses.
bool SceneProbeState::RaySearch::find_local(const octree::RigidTransform& transform,
                                            const octree::LineRange& range, double wanted,
                                            LocalRay& local) const noexcept {
  const Vec3 from = ray_.origin + ray_.direction * range.lower;
  const Vec3 to = ray_.origin + ray_.direction * range.upper;
  if (!octree::RigidTransform::is_in_range(from) || !octree::RigidTransform::is_in_range(to))
    return false;
  const Vec3 &origin = ray_.origin, &translation = transform.translation();
  const double reach = std::max(upper_length(from - translation), upper_length(to - translation));
  const double rounding =
      kRayRounding * (upper_length(from) + upper_length(to) + upper_length(origin));
  local.range = range;
  local.way = {transform.apply_inverse(from), transform.apply_inverse(to), 0};
  const Vec3 direction = local.way.to - local.way.from;
  local.error =
      transform.position_error(reach) + rounding + kDifferenceRounding * upper_length(direction);
  local.way.radius = local.error;
  local.ray = {local.way.from, direction, 0, 1};
  if (!(wanted < range.upper)) return true;
  const double share = (wanted - range.lower) / (range.upper - range.lower);
  local.ray.t_max = std::min(1.0, octree::upper_end(share + kDifferenceRounding));
  local.length = local.ray.t_max * upper_length(direction);
  return true;
}

// Returns the hit of a ray in the frame of an instance, with positions of the ray in the world.
RayHit SceneProbeState::RaySearch::find_hit(ProbeState& probe, const LocalRay& local) noexcept {
  if (!is_valid(local.ray)) return nothing_before(0, Status::kDegraded);  // no length is left
  QueryOptions options = options_;
  options.max_distance = kInfinity;
  const FirstHit first =
      spending(probe, options_, [&] { return probe.find_first_hit(local.ray, options); });
  RayHit hit = first.hit;
  if (!(hit.t <= 1)) return hit;
  const double lower = between(local.range, hit.t_lower);
  const double upper = between(local.range, std::min(hit.t_upper, 1.0));
  hit.t = std::min(between(local.range, hit.t), local.range.upper);
  hit.t_upper = kInfinity;
  const Vec3& direction = local.ray.direction;
  const double cosine = std::fabs(dot(hit.normal, direction)) / upper_length(direction);
  const double tolerance = crossing_tolerance(first.corners, hit.barycentric, cosine);
  if (local.error > probe.model().geometry.scale.out(tolerance)) return hit;
  // The crossing is off by less than twice the error over the cosine, see crossing_tolerance().
  const double off = octree::upper_end(
      2 * local.error / (cosine * speed_) * (1 + octree::kClipMargin) + rounding_in(local.range));
  // It may be before the start of the ray, or behind its end.
  if (lower - off > ray_.t_min && upper + off < ray_.t_max)
    hit.t_upper = octree::upper_end(upper + off);
  return hit;
}

SceneRayHit SceneProbeState::RaySearch::finish() noexcept {
  SceneRayHit answer{first_.best(), first_.instance()};
  answer.status = first_.status();
  answer.t_lower = first_.lower();
  answer.t_upper = first_.is_found() ? first_.upper() : kInfinity;
  return answer;
}

}  // namespace planetree::query
