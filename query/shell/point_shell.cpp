#include "planetree/point_shell.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <new>
#include <utility>

#include "octree/geometry/fp_environment.h"
#include "octree/geometry/rigid_transform.h"
#include "octree/geometry/strict_math.h"
#include "query/shell/probe_source.h"
#include "query/shell/shell_memory.h"
#include "query/shell/shell_wrench.h"
#include "query/shell/sphere_tree.h"
#include "query/shell/vectors.h"

namespace planetree {
namespace {

using octree::RigidTransform;

Error bad_shell(const char* cause, std::size_t point) {
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "point %zu of the shell: %s", point, cause);
}

Error no_memory(const char* what) {
  return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                    "no memory for %s; free some and try again", what);
}

}  // namespace

Result<PointShell> PointShell::create(std::span<const ShellPoint> points) {
  if (points.empty() || points.size() > kMaxPoints)
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "a shell has 1 to %zu points, not %zu", kMaxPoints, points.size());
  const octree::FpEnvironmentGuard host;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!RigidTransform::is_in_range(points[i].position))
      return bad_shell("give a position with coordinates of at most 2^500", i);
    const double length2 = query::dot(points[i].normal, points[i].normal);
    if (!(std::fabs(length2 - 1) <= Pose::kMaxLengthError))
      return bad_shell("give a normal of length 1", i);
  }
  try {
    return PointShell(std::make_unique<const query::SphereTree>(points));
  } catch (const std::bad_alloc&) {
    return no_memory("a point shell");
  }
}

PointShell::PointShell(std::unique_ptr<const query::SphereTree> tree) noexcept
    : tree_(std::move(tree)) {}
PointShell::PointShell(PointShell&&) noexcept = default;
PointShell& PointShell::operator=(PointShell&&) noexcept = default;
PointShell::~PointShell() = default;

std::size_t PointShell::size() const noexcept { return tree_->points().size(); }

Wrench PointShell::wrench(Probe& probe, PointShellState& state, const Pose& pose,
                          const ShellOptions& options,
                          std::span<ShellContact> contacts) const noexcept {
  assert(&state.memory_->tree == tree_.get());
  const octree::FpEnvironmentGuard host;
  const auto transform = RigidTransform::of(pose);
  if (!transform || !query::is_valid(options)) return {};
  query::ShellMemory& memory = *state.memory_;
  query::ProbeSource<Probe> source(probe, *state.info_);
  const Wrench wrench = query::shell_wrench(source, memory, {*transform}, options);
  const std::size_t count = std::min(memory.hits.size(), contacts.size());
  for (std::size_t i = 0; i < count; ++i) contacts[i] = contact_of(memory.hits[i], *tree_);
  return wrench;
}

Result<PointShellState> PointShellState::create(const PointShell& shell, const Model& model) {
  try {
    return PointShellState(std::make_unique<query::ShellMemory>(*shell.tree_), model.info());
  } catch (const std::bad_alloc&) {
    return no_memory("the state of a point shell");
  }
}

PointShellState::PointShellState(std::unique_ptr<query::ShellMemory> memory,
                                 const ModelInfo& info) noexcept
    : memory_(std::move(memory)), info_(&info) {}
PointShellState::PointShellState(PointShellState&&) noexcept = default;
PointShellState& PointShellState::operator=(PointShellState&&) noexcept = default;
PointShellState::~PointShellState() = default;

void PointShellState::reset() noexcept { memory_->forget(); }

}  // namespace planetree
