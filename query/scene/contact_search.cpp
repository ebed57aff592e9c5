#include "query/scene/contact_search.h"

#include <algorithm>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "octree/nearest/interval_ends.h"
#include "query/scene/scene_model.h"
#include "query/shell/vectors.h"

namespace planetree::query {
namespace {

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

}  // namespace

SceneProbeState::ContactSearch::ContactSearch(SceneProbeState& scene, const Sweep& sweep,
                                              double seconds, const QueryOptions& options) noexcept
    : scene_(scene),
      view_(scene.view_),
      sweep_(sweep),
      seconds_(seconds),
      options_(with_defaults(options)) {}

SceneFirstContact SceneProbeState::ContactSearch::run() noexcept {
  const Vec3 &a = sweep_.from, &b = sweep_.to;
  const Vec3 lower{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
  const Vec3 upper{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
  for (std::size_t index = 0; index < view_.size(); ++index) visit(index, lower, upper);
  return finish();
}

// lower, upper  corners of the box of the way of the centre
void SceneProbeState::ContactSearch::visit(std::size_t index, const Vec3& lower,
                                           const Vec3& upper) noexcept {
  if (!view_.is_placed(index)) return offer_nothing_known(index);
  const Placement& placement = view_.placement(index);
  const double reach = octree::upper_end(
      PlacementMotion::way_bound(placement.twist, seconds_, view_.reach(index)) + sweep_.radius);
  // An only instance is asked, so that the scene answers as its model does.
  if (view_.size() > 1 && !view_.overlaps(index, lower, upper, reach)) return;
  const auto motion = PlacementMotion::of(placement, seconds_);
  if (!motion) return offer_nothing_known(index);
  offer(index, ask(index, *motion));
}

FirstContact SceneProbeState::ContactSearch::ask(std::size_t index,
                                                 const PlacementMotion& motion) noexcept {
  const PlacementMotion::LocalSweep local = motion.to_local(sweep_);
  Sweep wider = local.sweep;
  if (local.error > 0) wider.radius = octree::upper_end(wider.radius + local.error);
  ProbeState& probe = scene_.probe(index);
  FirstContact contact =
      spending(probe, options_, [&] { return probe.first_contact(wider, options_); });
  if (motion.is_identity() || !(contact.t <= 1)) return contact;
  contact.t_upper = certain_touch(local.sweep, contact.t, contact.at.point,
                                  local.error + (contact.at.upper - contact.at.lower));
  to_world(motion.at(contact.t), local.error, contact.at);
  return contact;
}

void SceneProbeState::ContactSearch::offer(std::size_t index,
                                           const FirstContact& contact) noexcept {
  is_free_ = is_free_ && contact.free;
  first_.offer(contact, view_.id(index));
}

void SceneProbeState::ContactSearch::offer_nothing_known(std::size_t index) noexcept {
  FirstContact unknown;
  unknown.status = Status::kDegraded;
  offer(index, unknown);
}

SceneFirstContact SceneProbeState::ContactSearch::finish() noexcept {
  SceneFirstContact answer{first_.best(), first_.instance()};
  answer.t_lower = first_.lower();
  answer.t_upper = first_.upper();
  answer.free = is_free_;
  answer.status = answer.at.status = first_.status();
  return answer;
}

}  // namespace planetree::query
