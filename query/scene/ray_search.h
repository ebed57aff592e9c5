#pragma once

#include <cstddef>
#include <limits>

#include "planetree/contact.h"
#include "planetree/scene.h"
#include "query/scene/earliest_answer.h"
#include "query/scene/scene_probe.h"

namespace planetree::query {

/// The search for the first hit of a ray with any instance, in the order in which it enters their
/// boxes. Beside a moved instance a ball goes along the ray, as wide as the ray is off in the frame
/// of the instance: what is free of it is free. If it is not, the ray itself is asked for.
class SceneProbeState::RaySearch {
 public:
  /// For a query in a section of the probe.
  RaySearch(SceneProbeState& scene, const Ray& ray, const QueryOptions& options) noexcept;

  SceneRayHit run() noexcept;

  /// Whether a direction can be turned: lengths from 2^-400 to 2^400.
  static bool can_turn(const Vec3& direction) noexcept;

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  /// The part of a ray in the box of an instance, in the instance's frame. Positions on it are 0 to
  /// 1.
  struct LocalRay {
    octree::LineRange range;  ///< the ray's t at 0 and at 1
    Sweep way;                ///< with a radius that holds the error
    Ray ray;
    double error;               ///< bound on the distance from the true position, at any t
    double length = kInfinity;  ///< beyond which nothing is wanted
  };

  void visit(std::size_t index) noexcept;
  RayHit ask(std::size_t index) noexcept;
  RayHit ask_moved(std::size_t index, const octree::RigidTransform& transform) noexcept;
  bool find_local(const octree::RigidTransform& transform, const octree::LineRange& range,
                  double wanted, LocalRay& local) const noexcept;
  RayHit find_hit(ProbeState& probe, const LocalRay& local) noexcept;
  SceneRayHit finish() noexcept;

  SceneProbeState& scene_;
  InstanceView& view_;
  const Ray ray_;
  double speed_;          // upper bound on the length of the direction
  double end_;            // t at which max_distance ends the ray, or t_max
  QueryOptions options_;  // with the work that is left
  EarliestAnswer<RayHit> first_;
};

}  // namespace planetree::query
