#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

#include "planetree/error.h"
#include "planetree/pose.h"
#include "tools/scene/opened_scene.h"

namespace planetree::tools {

/// The pose of an instance some time after the start, by its velocities: the origin moves straight,
/// and the axes turn about a fixed axis. Computed from the start, so that errors do not add up.
Pose pose_after(const InstanceDescription& instance, double seconds);

/// The instances of a scene that move, tick by tick.
class SceneMotion {
 public:
  /// description, opened  must outlive this; of the same scene
  /// period               time between ticks
  SceneMotion(const SceneDescription& description, OpenedScene& opened,
              std::chrono::nanoseconds period);

  /// Fails if an instance leaves the range of poses within so many ticks.
  ///
  /// errors  kBadInput: which instance
  Result<void> check(std::size_t ticks) const;
  /// Puts each instance that moves where it is at a tick. Takes a fixed time for each, and makes no
  /// system call.
  void begin_tick(std::size_t tick) const noexcept;
  bool moves(std::size_t instance) const;  ///< whether an instance of the file moves
  bool any_moves() const { return !moving_.empty(); }

 private:
  double seconds_at(std::size_t tick) const;

  const SceneDescription& description_;
  OpenedScene& opened_;
  const std::chrono::nanoseconds period_;
  std::vector<std::size_t> moving_;  // positions, ascending
};

}  // namespace planetree::tools
