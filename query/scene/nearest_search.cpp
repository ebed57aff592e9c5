#include "query/scene/nearest_search.h"

#include <algorithm>

#include "octree/geometry/strict_math.h"
#include "octree/nearest/interval_ends.h"
#include "query/answer/closest_point.h"

namespace planetree::query {
SceneProbeState::NearestSearch::NearestSearch(SceneProbeState& scene, const Vec3& query,
                                              const QueryOptions& options) noexcept
    : scene_(scene),
      view_(scene.view_),
      query_(query),
      options_(with_defaults(options)),
      best_(unanswered(Status::kBeyondMaxDistance)),
      best_index_(view_.size()) {
  best_.lower = options.max_distance;
}

SceneClosestPoint SceneProbeState::NearestSearch::run() noexcept {
  if (view_.size() == 0) return {best_};
  view_.compute_bounds(query_);
  // All parts of the first one, which is the nearest one more often than not.
  visit(first(), options_.parts);
  for (double bound = view_.least_bound(); bound < kInfinity; bound = view_.least_bound()) {
    if (bound > std::min(upper_, options_.max_distance)) break;
    if (may_stop(bound)) {
      lower_ = std::min(lower_, bound);
      unproven_ = std::min(unproven_, bound);
      break;
    }
    visit(view_.nearest(), kDistance);
  }
  return finish();
}

// The instance that answered last, if its box is near enough to be worth it.
std::size_t SceneProbeState::NearestSearch::first() const noexcept {
  const std::size_t last = view_.find(scene_.last_instance_, scene_.last_index_);
  return last < view_.size() && view_.bound(last) <= view_.least_bound() ? last : view_.nearest();
}

bool SceneProbeState::NearestSearch::may_stop(double bound) const noexcept {
  return options_.max_error > 0 && upper_ - std::min(lower_, bound) <= options_.max_error;
}

void SceneProbeState::NearestSearch::visit(std::size_t index, std::uint32_t parts) noexcept {
  view_.mark_visited(index);
  if (!view_.is_placed(index)) {
    lower_ = unproven_ = 0;
    return;
  }
  offer(index, ask(index, parts, std::min(upper_, options_.max_distance)), parts);
}

// Returns what an instance answers, in the world frame.
ClosestPoint SceneProbeState::NearestSearch::ask(std::size_t index, std::uint32_t parts,
                                                 double max_distance) noexcept {
  const octree::RigidTransform transform = view_.transform(index);
  const LocalPoint local = to_local(transform, query_);
  QueryOptions options = options_;
  options.parts = parts;
  options.max_distance =
      local.error == 0 ? max_distance : octree::upper_end(max_distance + local.error);
  ProbeState& probe = scene_.probe(index);
  ClosestPoint answer =
      spending(probe, options_, [&] { return probe.closest_point(local.point, options); });
  if (hides_side(local, parts, answer.lower) && answer.status != Status::kBeyondMaxDistance)
    forget_side(answer);
  to_world(transform, local.error, answer);
  return answer;
}

bool SceneProbeState::NearestSearch::is_better(const ClosestPoint& answer,
                                               std::size_t index) const noexcept {
  if (best_index_ == view_.size()) return true;
  if (answer.status == Status::kBeyondMaxDistance) return false;
  if (best_.status == Status::kBeyondMaxDistance || answer.distance < best_.distance) return true;
  return answer.distance == best_.distance && view_.id(index) < view_.id(best_index_);
}

void SceneProbeState::NearestSearch::offer(std::size_t index, const ClosestPoint& answer,
                                           std::uint32_t parts) noexcept {
  lower_ = std::min(lower_, answer.lower);
  upper_ = std::min(upper_, answer.upper);
  if (answer.status == Status::kDegraded || answer.status == Status::kWithinError)
    unproven_ = std::min(unproven_, answer.lower);
  if (!is_better(answer, index)) return;
  best_ = answer;
  best_index_ = index;
  best_parts_ = parts;
}

SceneClosestPoint SceneProbeState::NearestSearch::finish() noexcept {
  if (best_index_ == view_.size()) {  // none is placed
    best_ = unanswered(Status::kDegraded);
    return {best_};
  }
  if (best_parts_ != options_.parts && best_.status != Status::kBeyondMaxDistance) {
    best_ = ask(best_index_, options_.parts, options_.max_distance);
    lower_ = std::min(lower_, best_.lower);
    upper_ = std::min(upper_, best_.upper);
  }
  SceneClosestPoint answer{best_};
  if (best_.status != Status::kBeyondMaxDistance) {
    answer.instance = view_.id(best_index_);
    answer.upper = upper_;
  }
  answer.lower = std::min(lower_, options_.max_distance);
  if (best_.status != Status::kDegraded && unproven_ < upper_)
    answer.status = answer.upper - answer.lower <= options_.max_error ? Status::kWithinError
                                                                      : Status::kDegraded;
  scene_.last_instance_ = view_.id(best_index_);
  scene_.last_index_ = best_index_;
  return answer;
}

}  // namespace planetree::query
