#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "octree/geometry/rigid_transform.h"
#include "planetree/scene_shell.h"
#include "query/scene/scene_probe.h"
#include "query/scene/scene_shell_memory.h"
#include "query/shell/shell_query.h"

namespace planetree::query {

/// The wrench of all instances on a tool: the sum of what each does, in the world's axes.
class SceneProbeState::ShellSum {
 public:
  /// For a query in a section of the probe.
  ///
  /// tool  of the pose of the tool in the world
  ShellSum(SceneProbeState& scene, SceneShellMemory& memory, const Pose& pose,
           const octree::RigidTransform& tool, const ShellOptions& options,
           std::span<SceneShellContact> contacts) noexcept;

  Wrench run() noexcept;

 private:
  bool is_out_of_reach(std::size_t index) const noexcept;
  void visit(std::size_t index) noexcept;
  std::optional<ToolPlace> place_in(std::size_t index,
                                    const octree::RigidTransform& transform) const noexcept;
  void add(const Wrench& local, const octree::RigidTransform& transform) noexcept;
  void list(const ShellMemory& memory, std::size_t index,
            const octree::RigidTransform& transform) noexcept;
  void add_unknown() noexcept;
  Wrench finish() noexcept;

  SceneProbeState& scene_;
  InstanceView& view_;
  SceneShellMemory& memory_;
  const Pose pose_;
  const octree::RigidTransform& tool_;
  ShellOptions options_;  // with the work that is left
  const bool is_limited_;
  const std::span<SceneShellContact> contacts_;
  double reach_ = 0;  // distance from the middle of the shell beyond which nothing touches it
  Wrench sum_;
  double force_lengths_ = 0, torque_lengths_ = 0;  // of the terms
  std::size_t terms_ = 0;
  bool is_exact_ = true;
};

}  // namespace planetree::query
