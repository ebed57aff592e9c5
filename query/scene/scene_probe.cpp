#include "query/scene/scene_probe.h"

#include <algorithm>
#include <cmath>

#include "octree/geometry/strict_math.h"
#include "octree/nearest/interval_ends.h"
#include "query/answer/closest_point.h"
#include "query/answer/model_line.h"
#include "query/scene/contact_search.h"
#include "query/scene/contact_set_search.h"
#include "query/scene/nearest_search.h"
#include "query/scene/ray_search.h"
#include "query/scene/scene_model.h"
#include "query/scene/shell_sum.h"
#include "query/shell/vectors.h"

namespace planetree::query {

SceneProbeState::LocalPoint SceneProbeState::to_local(const octree::RigidTransform& transform,
                                                      const Vec3& point) noexcept {
  if (transform.is_identity()) return {point, 0};
  const double reach = upper_length(point - transform.translation());
  return {transform.apply_inverse(point), transform.position_error(reach)};
}

void SceneProbeState::to_world(const octree::RigidTransform& transform, double error,
                               ClosestPoint& answer) noexcept {
  if (transform.is_identity()) return;
  answer.lower = octree::lower_end(answer.lower - error);
  answer.upper = octree::upper_end(answer.upper + error);
  if (answer.status == Status::kBeyondMaxDistance) return;
  answer.point = transform.apply(answer.point);
  answer.normal = transform.rotate(answer.normal);
}

bool SceneProbeState::can_place(const Vec3& point) const noexcept {
  return view_.is_still() || octree::RigidTransform::is_in_range(point);
}

SceneClosestPoint SceneProbeState::closest_point(const Vec3& query,
                                                 const QueryOptions& options) noexcept {
  if (!is_valid(query, options)) return {unanswered(Status::kBadQuery)};
  const Section section(*this);
  if (!can_place(query)) return {unanswered(Status::kBadQuery)};
  if ((options.parts & (kDistance | kNormal)) != 0)
    return NearestSearch(*this, query, options).run();
  SceneClosestPoint answer{unanswered(Status::kExact)};
  if ((options.parts & kSide) == 0) return answer;
  const SceneContainment side = find_side(query, options);
  answer.side = side.side;
  answer.status = side.status;
  answer.instance = side.instance;
  return answer;
}

SceneContainment SceneProbeState::contains(const Vec3& query,
                                           const QueryOptions& options) noexcept {
  if (!is_valid(query, options)) return {};
  const Section section(*this);
  return can_place(query) ? find_side(query, options) : SceneContainment{};
}

// Inside of one instance is inside, whatever the others say.
SceneContainment SceneProbeState::find_side(const Vec3& query,
                                            const QueryOptions& options) noexcept {
  QueryOptions left = with_defaults(options);
  view_.compute_bounds(query);
  bool is_known = true, is_on_surface = false;
  InstanceId inside = kNoInstance, on_surface = kNoInstance;
  for (std::size_t index = 0; index < view_.size(); ++index) {
    const Containment side = side_of(index, query, left);
    is_known = is_known && side.side != Side::kUnknown;
    if (side.side == Side::kInside) inside = std::min(inside, view_.id(index));
    if (side.side != Side::kOnSurface) continue;
    is_on_surface = true;
    on_surface = std::min(on_surface, view_.id(index));
  }
  if (inside != kNoInstance) return {{Side::kInside, Status::kExact}, inside};
  if (!is_known) return {{Side::kUnknown, Status::kDegraded}, kNoInstance};
  if (is_on_surface) return {{Side::kOnSurface, Status::kExact}, on_surface};
  return {{Side::kOutside, Status::kExact}, kNoInstance};
}

Containment SceneProbeState::side_of(std::size_t index, const Vec3& query,
                                     QueryOptions& left) noexcept {
  if (!view_.is_placed(index)) return {Side::kUnknown, Status::kDegraded};
  const SideMeans means = view_.model(index).serving->geometry.side_means(left.side_rule);
  // A solid has no inside out of its box. The other means decide anywhere.
  if (means == SideMeans::kWindingNumber && view_.bound(index) > 0)
    return {Side::kOutside, Status::kExact};
  const LocalPoint local = to_local(view_.transform(index), query);
  ProbeState& probe = this->probe(index);
  return spending(probe, left, [&]() -> Containment {
    const Containment side = probe.contains(local.point, left);
    const bool is_hidden =
        local.error > 0 && side.side != Side::kUnknown && is_surface_near(probe, local, left);
    return is_hidden ? Containment{Side::kUnknown, Status::kDegraded} : side;
  });
}

// Whether the surface may lie between a point and where it would be without rounding.
bool SceneProbeState::is_surface_near(ProbeState& probe, const LocalPoint& local,
                                      QueryOptions options) noexcept {
  options.parts = kDistance;
  options.max_error = 0;
  options.max_distance = local.error;
  return probe.closest_point(local.point, options).lower < local.error;
}

SceneFirstContact SceneProbeState::first_contact(const Sweep& sweep, double seconds,
                                                 const QueryOptions& options) noexcept {
  if (!is_valid(sweep.from, options) || !is_valid(sweep) || !(seconds >= 0) ||
      !std::isfinite(seconds))
    return {};
  const Section section(*this);
  if (!can_place(sweep.from) || !can_place(sweep.to)) return {};
  return ContactSearch(*this, sweep, seconds, options).run();
}

Found SceneProbeState::contacts(const Vec3& query, double radius,
                                std::span<SceneClosestPoint> found,
                                const QueryOptions& options) noexcept {
  if (!is_valid(query, options) || !(radius >= 0)) return {};
  const Section section(*this);
  if (!can_place(query)) return {};
  return ContactSetSearch(*this, query, radius, options, found).run();
}

SceneRayHit SceneProbeState::first_hit(const Ray& ray, const QueryOptions& options) noexcept {
  if (!is_valid(ray.origin, options) || !is_valid(ray)) return {};
  const Section section(*this);
  if (!can_place(ray.origin) || !(view_.is_still() || RaySearch::can_turn(ray.direction)))
    return {};
  return RaySearch(*this, ray, options).run();
}

Wrench SceneProbeState::wrench(SceneShellMemory& memory, const Pose& pose,
                               const ShellOptions& options,
                               std::span<SceneShellContact> contacts) noexcept {
  const auto tool = octree::RigidTransform::of(pose);
  if (!tool || !is_valid(options)) return {};
  const Section section(*this);
  return ShellSum(*this, memory, pose, *tool, options, contacts).run();
}

void SceneProbeState::note_motion(const Vec3& position, const Vec3& velocity) noexcept {
  const Section section(*this);
  const std::size_t index = view_.find(last_instance_, last_index_);
  if (index == view_.size() || !view_.is_placed(index) || !can_place(position)) return;
  const octree::RigidTransform transform = view_.transform(index);
  const Twist& twist = view_.placement(index).twist;
  const Vec3 relative =
      velocity - twist.linear - cross(twist.angular, position - transform.translation());
  probe(index).note_motion(to_local(transform, position).point, transform.rotate_inverse(relative));
}

}  // namespace planetree::query
