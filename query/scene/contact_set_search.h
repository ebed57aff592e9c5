#pragma once

#include <cstddef>
#include <span>

#include "planetree/scene.h"
#include "query/scene/scene_probe.h"

namespace planetree::query {

/// The search for the contacts of a ball with all instances: best first, by the bounds of their
/// boxes. The contacts of an instance come to the probe's own memory, and from there, in order, to
/// those of the others.
class SceneProbeState::ContactSetSearch {
 public:
  /// For a query in a section of the probe.
  ContactSetSearch(SceneProbeState& scene, const Vec3& query, double radius,
                   const QueryOptions& options, std::span<SceneClosestPoint> found) noexcept;

  Found run() noexcept;

 private:
  bool is_full() const noexcept { return count_ == found_.size(); }
  /// Distance beyond which no contact is wanted.
  double reach() const noexcept;
  void visit(std::size_t index) noexcept;
  Found ask(std::size_t index) noexcept;
  void offer(const ClosestPoint& contact, InstanceId instance) noexcept;

  SceneProbeState& scene_;
  InstanceView& view_;
  const Vec3 query_;
  const double radius_;
  QueryOptions options_;                       // with the work that is left
  const std::span<ClosestPoint> of_instance_;  // contacts of the instance that is visited
  const std::span<SceneClosestPoint> found_;   // the first count_ are in order
  std::size_t count_ = 0;
  bool is_complete_ = true;
};

}  // namespace planetree::query
