#include "query/scene/contact_set_search.h"

#include <algorithm>

#include "octree/geometry/strict_math.h"

namespace planetree::query {

SceneProbeState::ContactSetSearch::ContactSetSearch(SceneProbeState& scene, const Vec3& query,
                                                    double radius, const QueryOptions& options,
                                                    std::span<SceneClosestPoint> found) noexcept
    : scene_(scene),
      view_(scene.view_),
      query_(query),
      radius_(std::min(radius, options.max_distance)),
      options_(with_defaults(options)),
      of_instance_(scene.scene_.found(scene.number_)),
      found_(found.first(std::min(found.size(), of_instance_.size()))) {}

Found SceneProbeState::ContactSetSearch::run() noexcept {
  if (found_.empty()) return {};
  view_.compute_bounds(query_);
  for (std::size_t index = view_.nearest(); index < view_.size(); index = view_.nearest()) {
    const double bound = view_.bound(index);
    if (bound > reach()) {
      is_complete_ = is_complete_ && bound > radius_;
      break;
    }
    view_.mark_visited(index);
    visit(index);
  }
  if (count_ > 0) scene_.last_instance_ = found_[0].instance;
  return {count_, is_complete_};
}

double SceneProbeState::ContactSetSearch::reach() const noexcept {
  return is_full() ? std::min(radius_, found_.back().distance) : radius_;
}

// What does not fit comes after what an instance finds within the reach. So nothing that lacks
// comes before what is kept.
void SceneProbeState::ContactSetSearch::visit(std::size_t index) noexcept {
  if (!view_.is_placed(index)) {
    is_complete_ = false;
    return;
  }
  // With a full set other contacts of the instance may be beyond the reach.
  is_complete_ = is_complete_ && !(is_full() && reach() < radius_);
  const Found contacts = ask(index);
  is_complete_ = is_complete_ && contacts.complete;
  for (const ClosestPoint& contact : of_instance_.first(contacts.count))
    offer(contact, view_.id(index));
}

// Returns the contacts of an instance, in the world frame.
Found SceneProbeState::ContactSetSearch::ask(std::size_t index) noexcept {
  const octree::RigidTransform transform = view_.transform(index);
  const LocalPoint local = to_local(transform, query_);
  ProbeState& probe = scene_.probe(index);
  const auto room = of_instance_.first(found_.size());
  const Found contacts = spending(
      probe, options_, [&] { return probe.find_contacts(local.point, reach(), room, options_); });
  const bool is_hidden = contacts.count > 0 && hides_side(local, options_.parts, room[0].lower);
  for (ClosestPoint& contact : room.first(contacts.count)) {
    if (is_hidden) forget_side(contact);
    to_world(transform, local.error, contact);
  }
  return contacts;
}

// Those of one instance come in order.
void SceneProbeState::ContactSetSearch::offer(const ClosestPoint& contact,
                                              InstanceId instance) noexcept {
  const auto is_before = [&](const SceneClosestPoint& other) {
    return other.distance != contact.distance ? other.distance < contact.distance
                                              : other.instance <= instance;
  };
  if (is_full()) {
    is_complete_ = false;
    if (is_before(found_.back())) return;
    --count_;
  }
  std::size_t at = count_++;
  for (; at > 0 && !is_before(found_[at - 1]); --at) found_[at] = found_[at - 1];
  found_[at] = {contact, instance};
}

}  // namespace planetree::query
