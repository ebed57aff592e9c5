#include "query/scene/shell_sum.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "octree/nearest/interval_ends.h"
#include "query/scene/scene_model.h"
#include "query/shell/probe_source.h"
#include "query/shell/shell_wrench.h"
#include "query/shell/vectors.h"

namespace planetree::query {
namespace {

// Error of the quaternion of a relative pose: four products and three sums err by 8 u, the division
// by the length by 3 u. A rotation errs by twice that.
constexpr double kRelativeRounding = 32 * octree::kDoubleRoundoff;

// The rotation a^-1 b, of length 1.
Quaternion relative(const Quaternion& a, const Quaternion& b) {
  const Quaternion q{
      a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z, a.w * b.x - a.x * b.w - a.y * b.z + a.z * b.y,
      a.w * b.y + a.x * b.z - a.y * b.w - a.z * b.x, a.w * b.z - a.x * b.y + a.y * b.x - a.z * b.w};
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w / length, q.x / length, q.y / length, q.z / length};
}

bool has_limit(const ShellOptions& options) {
  return options.wait == Wait::kNever || options.max_work != QueryOptions::kNoLimit;
}

}  // namespace

SceneProbeState::ShellSum::ShellSum(SceneProbeState& scene, SceneShellMemory& memory,
                                    const Pose& pose, const octree::RigidTransform& tool,
                                    const ShellOptions& options,
                                    std::span<SceneShellContact> contacts) noexcept
    : scene_(scene),
      view_(scene.view_),
      memory_(memory),
      pose_(pose),
      tool_(tool),
      options_(options),
      is_limited_(has_limit(options)),
      contacts_(contacts) {
  if (is_limited_ && options.max_work == QueryOptions::kNoLimit)
    options_.max_work = ShellOptions::kRealTimeWork;
  const double length = options.margin + memory.tree().nodes()[0].radius;
  reach_ = length + 4 * tool.position_error(memory.tree().reach()) + octree::kShellSlack * length;
  sum_.force_error = sum_.torque_error = 0;
}

Wrench SceneProbeState::ShellSum::run() noexcept {
  view_.compute_bounds(tool_.apply(memory_.tree().nodes()[0].centre));
  for (std::size_t index = view_.nearest(); index < view_.size(); index = view_.nearest()) {
    const bool is_far = is_out_of_reach(index);
    view_.mark_visited(index);
    if (!is_far) visit(index);
  }
  return finish();
}

// A solid has no inside out of its box. Other sides are decided anywhere.
bool SceneProbeState::ShellSum::is_out_of_reach(std::size_t index) const noexcept {
  if (!(view_.bound(index) > reach_)) return false;
  return options_.depth_rule == DepthRule::kTwoSided ||
         view_.model(index).serving->geometry.side_means(options_.side_rule) ==
             SideMeans::kWindingNumber;
}

void SceneProbeState::ShellSum::visit(std::size_t index) noexcept {
  if (!view_.is_placed(index)) return add_unknown();
  const octree::RigidTransform transform = view_.transform(index);
  const auto place = place_in(index, transform);
  if (!place) return add_unknown();
  ProbeSource<ProbeState> source(scene_.probe(index), view_.model(index).info);
  ShellMemory& memory = memory_.of(view_.id(index));
  const Wrench local = shell_wrench(source, memory, *place, options_);
  if (is_limited_)
    options_.max_work -=
        static_cast<std::uint32_t>(std::min<std::uint64_t>(local.work, options_.max_work));
  list(memory, index, transform);
  add(local, transform);
}

// Returns the place of the tool in the frame of an instance; nothing if it is out of the range of
// poses.
//
// A point p of the tool is at x = R p + t in the world, which its own pose defines to within an
// error, and at S^T (x - s) in the frame of the instance, within the error of that pose. The
// relative pose errs by its own rounding besides.
std::optional<ToolPlace> SceneProbeState::ShellSum::place_in(
    std::size_t index, const octree::RigidTransform& transform) const noexcept {
  if (transform.is_identity()) return ToolPlace{tool_};
  const Pose& pose = view_.placement(index).pose;
  const auto place = octree::RigidTransform::of(
      {relative(pose.rotation, pose_.rotation), transform.apply_inverse(pose_.translation)});
  if (!place) return {};
  const double reach = memory_.tree().reach();
  const double away = upper_length(pose_.translation - transform.translation()) + reach;
  return ToolPlace{
      *place,
      tool_.position_error(reach) + transform.position_error(away) + kRelativeRounding * reach,
      tool_.rotation_error() + transform.rotation_error() + kRelativeRounding};
}

void SceneProbeState::ShellSum::add(const Wrench& local,
                                    const octree::RigidTransform& transform) noexcept {
  Wrench turned = local;
  if (!transform.is_identity()) {
    turned.force = transform.rotate(local.force);
    turned.torque = transform.rotate(local.torque);
    turned.force_error += transform.rotation_error() * upper_length(local.force);
    turned.torque_error += transform.rotation_error() * upper_length(local.torque);
  }
  sum_.force = sum_.force + turned.force;
  sum_.torque = sum_.torque + turned.torque;
  sum_.force_error += turned.force_error;
  sum_.torque_error += turned.torque_error;
  force_lengths_ += upper_length(turned.force);
  torque_lengths_ += upper_length(turned.torque);
  ++terms_;
  sum_.contacts += local.contacts;
  sum_.undecided += local.undecided;
  sum_.listed += local.listed;
  sum_.queries += local.queries;
  sum_.work += local.work;
  is_exact_ = is_exact_ && local.status == Status::kExact;
}

// Adds the contacts of an instance to those that the caller gets.
void SceneProbeState::ShellSum::list(const ShellMemory& memory, std::size_t index,
                                     const octree::RigidTransform& transform) noexcept {
  const std::size_t first = std::min(sum_.listed, contacts_.size());
  const std::size_t count = std::min(memory.hits.size(), contacts_.size() - first);
  for (std::size_t i = 0; i < count; ++i) {
    SceneShellContact contact{contact_of(memory.hits[i], memory.tree), view_.id(index)};
    if (!transform.is_identity()) {
      contact.position = transform.apply(contact.position);
      contact.direction = transform.rotate(contact.direction);
    }
    contacts_[first + i] = contact;
  }
  if (memory.hits.empty()) return;
  scene_.last_instance_ = view_.id(index);
  scene_.last_index_ = index;
}

void SceneProbeState::ShellSum::add_unknown() noexcept {
  sum_.force_error = sum_.torque_error = std::numeric_limits<double>::infinity();
  is_exact_ = false;
}

Wrench SceneProbeState::ShellSum::finish() noexcept {
  if (terms_ > 1) {
    const double rounding = static_cast<double>(terms_ + 4) * 2 * octree::kDoubleRoundoff;
    sum_.force_error =
        octree::upper_end((sum_.force_error + rounding * force_lengths_) * (1 + rounding));
    sum_.torque_error =
        octree::upper_end((sum_.torque_error + rounding * torque_lengths_) * (1 + rounding));
  }
  if (!is_finite(sum_.force) || !is_finite(sum_.torque)) {
    sum_.force = sum_.torque = {};
    add_unknown();
  }
  sum_.status = is_exact_ ? Status::kExact : Status::kDegraded;
  return sum_;
}

}  // namespace planetree::query
