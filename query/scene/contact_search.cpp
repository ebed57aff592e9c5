#include "query/scene/contact_search.h"

#include <algorithm>
#include <cmath>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "query/answer/query_context.h"
#include "query/scene/scene_model.h"
#include "query/shell/vectors.h"

namespace planetree::query {
namespace {

double rounded_up(double value) { return value + octree::kEndRounding * std::fabs(value); }

// Returns a time at which the ball has touched a surface point for certain, or infinity. Near the
// contact, the ball comes nearer to the point by about its way times the cosine of the angle.
//
// contact  surface point in the frame of the instance, at the time t
// error    bound on the distance between the centre and its true position, and of the contact's
double certain_touch(const Sweep& local, double t, const Vec3& contact, double error) {
  constexpr int kMaxSteps = 24;
  const Vec3 way = local.to - local.from;
  const double length = upper_length(way);
  const double rounding =
      octree::kNormRounding * (upper_length(local.from) + length + upper_length(contact));
  double step = 0;
  for (int i = 0; i < kMaxSteps && step <= 1; ++i) {
    const double at = std::min(t + step, 1.0);
    const Vec3 centre = local.from + way * at;
    if (upper_length(centre - contact) + rounding + error <= local.radius) return at;
    step = step == 0 ? 4 * (error + rounding) / length : 2 * step;
  }
  return std::numeric_limits<double>::infinity();
}

// Moves a contact from the frame of an instance to the world.
void to_world(const octree::RigidTransform& transform, double error, ClosestPoint& at) {
  if (transform.is_identity()) return;
  at.lower = std::max(0.0, at.lower - rounded_up(error));
  at.upper = rounded_up(at.upper + error);
  at.point = transform.apply(at.point);
  at.normal = transform.rotate(at.normal);
}

}  // namespace

SceneProbeState::ContactSearch::ContactSearch(SceneProbeState& scene, const Sweep& sweep,
                                              double seconds, const QueryOptions& options) noexcept
    : scene_(scene),
      view_(scene.view_),
      sweep_(sweep),
      seconds_(seconds),
      options_(with_defaults(options)),
      best_index_(view_.size()) {}

SceneFirstContact SceneProbeState::ContactSearch::run() noexcept {
  const Vec3 &a = sweep_.from, &b = sweep_.to;
  const double r = rounded_up(sweep_.radius);
  const auto below = [r](double x, double y) {
    const double least = std::min(x, y);
    return least - rounded_up(r) - octree::kEndRounding * std::fabs(least);
  };
  const auto above = [r](double x, double y) { return rounded_up(std::max(x, y) + r); };
  const Vec3 lower{below(a.x, b.x), below(a.y, b.y), below(a.z, b.z)};
  const Vec3 upper{above(a.x, b.x), above(a.y, b.y), above(a.z, b.z)};
  for (std::size_t index = 0; index < view_.size(); ++index) visit(index, lower, upper);
  return finish();
}

// lower, upper  corners of a box around the whole motion
void SceneProbeState::ContactSearch::visit(std::size_t index, const Vec3& lower,
                                           const Vec3& upper) noexcept {
  if (!view_.is_placed(index)) return offer_nothing_known(index);
  const Placement& placement = view_.placement(index);
  const double way = PlacementMotion::way_bound(placement.twist, seconds_, view_.reach(index));
  // An only instance is asked, so that the scene answers as its model does.
  if (view_.size() > 1 && !view_.overlaps(index, lower, upper, way)) return;
  const auto motion = PlacementMotion::of(placement, seconds_);
  if (!motion) return offer_nothing_known(index);
  offer(index, ask(index, *motion));
}

FirstContact SceneProbeState::ContactSearch::ask(std::size_t index,
                                                 const PlacementMotion& motion) noexcept {
  const PlacementMotion::LocalSweep local = motion.to_local(sweep_);
  Sweep wider = local.sweep;
  if (local.error > 0) wider.radius = rounded_up(wider.radius + local.error);
  ProbeState& probe = scene_.probe(index);
  const std::uint64_t before = probe.work_spent();
  FirstContact contact = probe.first_contact(wider, options_);
  if (options_.max_work != QueryOptions::kNoLimit)
    options_.max_work -= static_cast<std::uint32_t>(
        std::min<std::uint64_t>(options_.max_work, probe.work_spent() - before));
  if (motion.is_identity() || !(contact.t <= 1)) return contact;
  contact.t_upper = certain_touch(local.sweep, contact.t, contact.at.point,
                                  local.error + (contact.at.upper - contact.at.lower));
  to_world(motion.at(contact.t), local.error, contact.at);
  return contact;
}

void SceneProbeState::ContactSearch::offer(std::size_t index,
                                           const FirstContact& contact) noexcept {
  lower_ = std::min(lower_, contact.t_lower);
  upper_ = std::min(upper_, contact.t_upper);
  is_free_ = is_free_ && contact.free;
  if (contact.status == Status::kBeyondMaxDistance)
    is_beyond_ = true;
  else if (contact.status != Status::kExact)
    unproven_ = std::min(unproven_, contact.t_lower);
  if (best_index_ < view_.size() && contact.t >= best_.t &&
      !(contact.t == best_.t && view_.id(index) < view_.id(best_index_)))
    return;
  best_ = contact;
  best_index_ = index;
}

void SceneProbeState::ContactSearch::offer_nothing_known(std::size_t index) noexcept {
  FirstContact unknown;
  unknown.status = Status::kDegraded;
  offer(index, unknown);
}

SceneFirstContact SceneProbeState::ContactSearch::finish() noexcept {
  SceneFirstContact answer{best_};
  if (best_index_ == view_.size()) {  // all are elsewhere
    answer.t_lower = kInfinity;
    answer.free = true;
    answer.status = answer.at.status = Status::kExact;
    return answer;
  }
  if (best_.t <= 1)
    answer.instance = view_.id(best_index_);
  else if (is_beyond_ && answer.status == Status::kExact)
    answer.status = Status::kBeyondMaxDistance;
  answer.t_lower = lower_;
  answer.t_upper = upper_;
  answer.free = is_free_;
  if (unproven_ < kInfinity && unproven_ <= std::min(best_.t, upper_))
    answer.status = Status::kDegraded;
  answer.at.status = answer.status;
  return answer;
}

}  // namespace planetree::query
