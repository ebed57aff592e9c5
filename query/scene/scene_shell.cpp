#include "planetree/scene_shell.h"

#include <cassert>
#include <new>
#include <utility>

#include "octree/geometry/fp_environment.h"
#include "octree/geometry/rigid_transform.h"
#include "query/scene/scene_probe.h"
#include "query/scene/scene_shell_memory.h"
#include "query/scene/shell_sum.h"

namespace planetree {

Wrench PointShell::wrench(SceneProbe& probe, SceneShellState& state, const Pose& pose,
                          const ShellOptions& options,
                          std::span<SceneShellContact> contacts) const noexcept {
  assert(&state.memory_->tree() == tree_.get());
  const octree::FpEnvironmentGuard host;
  return probe.state_->wrench(*state.memory_, pose, options, contacts);
}

Result<SceneShellState> SceneShellState::create(const PointShell& shell, std::uint32_t instances) {
  if (instances < 1 || instances > kMaxInstances)
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "the state of a shell keeps what it knows of 1 to %u instances, not of %u",
                      kMaxInstances, instances);
  try {
    return SceneShellState(std::make_unique<query::SceneShellMemory>(*shell.tree_, instances));
  } catch (const std::bad_alloc&) {
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory for the state of a point shell; free some and try again");
  }
}

SceneShellState::SceneShellState(std::unique_ptr<query::SceneShellMemory> memory) noexcept
    : memory_(std::move(memory)) {}
SceneShellState::SceneShellState(SceneShellState&&) noexcept = default;
SceneShellState& SceneShellState::operator=(SceneShellState&&) noexcept = default;
SceneShellState::~SceneShellState() = default;

void SceneShellState::reset() noexcept { memory_->forget(); }

}  // namespace planetree
