#include "planetree/point_shell.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <new>
#include <utility>

#include "octree/geometry/fp_environment.h"
#include "octree/geometry/rigid_transform.h"
#include "octree/geometry/strict_math.h"
#include "query/shell/shell_memory.h"
#include "query/shell/shell_query.h"
#include "query/shell/sphere_tree.h"
#include "query/shell/vectors.h"
#include "query/shell/wrench_sum.h"

namespace planetree {
namespace {

using octree::RigidTransform;

bool is_number(double value) { return value >= 0 && std::isfinite(value); }

bool is_valid(const ShellOptions& options) {
  return is_number(options.stiffness) && is_number(options.margin) && options.max_depth >= 0 &&
         RigidTransform::is_in_range(options.reference) &&
         options.depth_rule <= DepthRule::kTwoSided &&
         options.force_direction <= ForceDirection::kModelNormal &&
         options.side_rule <= SideRule::kSurface && options.wait <= Wait::kNever;
}

Error bad_shell(const char* cause, std::size_t point) {
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "point %zu of the shell: %s", point, cause);
}

Error no_memory(const char* what) {
  return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                    "no memory for %s; free some and try again", what);
}

ShellContact contact_of(const query::ShellHit& hit, const query::SphereTree& tree) {
  return {tree.points()[hit.point].number,
          hit.position,
          hit.direction,
          hit.depth,
          hit.depth_lower,
          hit.depth_upper,
          hit.is_proven ? Status::kExact : Status::kDegraded};
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
  Wrench wrench;
  const auto transform = RigidTransform::of(pose);
  if (!transform || !is_valid(options)) return wrench;
  query::ShellQuery query(probe, *state.memory_, *transform, options);
  query.run();

  // The sum does not depend on the order in which the points were found.
  auto& hits = state.memory_->hits;
  std::ranges::sort(
      hits, {}, [this](const query::ShellHit& hit) { return tree_->points()[hit.point].number; });
  query::WrenchSum sum(*tree_, *transform, options);
  for (const query::ShellHit& hit : hits) sum.add(hit);
  sum.finish(wrench);
  const std::size_t count = std::min(hits.size(), contacts.size());
  for (std::size_t i = 0; i < count; ++i) contacts[i] = contact_of(hits[i], *tree_);
  wrench.queries = query.queries();
  wrench.work = query.work();
  wrench.listed = hits.size();
  const bool is_finite = std::isfinite(wrench.force_error) && std::isfinite(wrench.torque_error);
  wrench.status = wrench.undecided == 0 && is_finite ? Status::kExact : Status::kDegraded;
  return wrench;
}

Result<PointShellState> PointShellState::create(const PointShell& shell, const Model& model) {
  try {
    return PointShellState(std::make_unique<query::ShellMemory>(*shell.tree_, model.info()));
  } catch (const std::bad_alloc&) {
    return no_memory("the state of a point shell");
  }
}

PointShellState::PointShellState(std::unique_ptr<query::ShellMemory> memory) noexcept
    : memory_(std::move(memory)) {}
PointShellState::PointShellState(PointShellState&&) noexcept = default;
PointShellState& PointShellState::operator=(PointShellState&&) noexcept = default;
PointShellState::~PointShellState() = default;

void PointShellState::reset() noexcept { memory_->forget(); }

}  // namespace planetree
