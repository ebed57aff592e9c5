#pragma once

#include <cstdint>
#include <memory>

#include "planetree/error.h"
#include "planetree/export.h"
#include "planetree/point_shell.h"
#include "planetree/scene.h"

/// @file
/// The memory of PointShell::wrench in scenes.

namespace planetree {

namespace query {
class SceneShellMemory;
}  // namespace query

/// A point of the shell that may be in contact with an instance: position and direction in the
/// world frame.
struct SceneShellContact : ShellContact {
  InstanceId instance = kNoInstance;  ///< the instance
};

/// What is known of each sphere and point of one shell in some instances of a scene, from call to
/// call. Takes about 240 bytes a point for each of them.
class PLANETREE_API SceneShellState {
 public:
  /// Limit of `instances` in create().
  static constexpr std::uint32_t kMaxInstances = 1024;

  /// Makes a state that knows nothing.
  ///
  /// shell      must outlive the state
  /// instances  number of instances of which it keeps what it knows, 1 to kMaxInstances. If the
  ///            tool is near more of them at once, it forgets what it knows of those that were near
  ///            earliest: they take more queries.
  /// errors     kBadArgument: `instances` is out of range. kNoMemory.
  /// threads    any, but not real-time threads: allocates memory and writes to all of it.
  [[nodiscard]] static Result<SceneShellState> create(const PointShell& shell,
                                                      std::uint32_t instances = 4);

  /// Moves another state here. That one may then only be assigned to or destroyed.
  SceneShellState(SceneShellState&&) noexcept;
  /// Destroys this state and moves another one here.
  SceneShellState& operator=(SceneShellState&&) noexcept;
  ~SceneShellState();

  /// Forgets what earlier calls found. Exact results do not depend on it.
  void reset() noexcept;

 private:
  friend class PointShell;
  explicit SceneShellState(std::unique_ptr<query::SceneShellMemory> memory) noexcept;
  std::unique_ptr<query::SceneShellMemory> memory_;
};

}  // namespace planetree
