#pragma once

#include <cstddef>

#include "planetree/contact.h"
#include "planetree/scene.h"
#include "query/scene/earliest_answer.h"
#include "query/scene/placement_motion.h"
#include "query/scene/scene_probe.h"

namespace planetree::query {

/// The search for the first contact of a moving ball with any instance. In the frame of an instance
/// the ball is asked for with a radius that is greater by the error of the motion there, so that
/// what is free is free. How late the contact can be is computed from the nearest surface point.
class SceneProbeState::ContactSearch {
 public:
  /// For a query in a section of the probe.
  ContactSearch(SceneProbeState& scene, const Sweep& sweep, double seconds,
                const QueryOptions& options) noexcept;

  SceneFirstContact run() noexcept;

 private:
  void visit(std::size_t index, const Vec3& lower, const Vec3& upper) noexcept;
  FirstContact ask(std::size_t index, const PlacementMotion& motion) noexcept;
  void offer(std::size_t index, const FirstContact& contact) noexcept;
  void offer_nothing_known(std::size_t index) noexcept;
  SceneFirstContact finish() noexcept;

  SceneProbeState& scene_;
  InstanceView& view_;
  const Sweep sweep_;
  const double seconds_;
  QueryOptions options_;  // with the work that is left
  EarliestAnswer<FirstContact> first_;
  bool is_free_ = true;  // of all instances
};

}  // namespace planetree::query
