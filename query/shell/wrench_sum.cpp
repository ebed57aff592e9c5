#include "query/shell/wrench_sum.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "query/shell/vectors.h"

namespace planetree::query {
namespace {

using octree::kDoubleRoundoff;

// A product that is 0 if one factor is, even if the other is infinite.
double times(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

}  // namespace

WrenchSum::WrenchSum(const SphereTree& tree, const ToolPlace& place, const ShellOptions& options)
    : tree_(tree),
      transform_(place.transform),
      options_(options),
      direction_error_(place.transform.rotation_error() + place.rotation_error +
                       tree.normal_error() + octree::kNormRounding) {}

void WrenchSum::add(const ShellHit& hit) {
  const double k = options_.stiffness;
  const Vec3 own = tree_.points()[hit.point].position - options_.reference;
  const Vec3 arm = transform_.rotate(own);
  const double reach = upper_length(own);
  const Vec3 moment = cross(arm, hit.direction);
  const Vec3 force = hit.direction * (k * hit.depth), torque = moment * (k * hit.depth);
  force_ = force_ + force;
  torque_ = torque_ + torque;
  ++terms_;
  contacts_ += hit.depth > 0;
  undecided_ += !hit.is_proven;

  const double off = std::max(hit.depth_upper - hit.depth, hit.depth - hit.depth_lower);
  const bool has_direction =
      hit.is_proven || options_.force_direction == ForceDirection::kToolNormal;
  const double greatest = k * hit.depth_upper;
  if (has_direction) {
    force_error_ += times(k, off) + times(greatest, direction_error_);
    torque_error_ +=
        times(times(k, off), upper_length(moment)) + times(greatest, 2 * direction_error_ * reach);
  } else {
    force_error_ += times(k, hit.depth + hit.depth_upper);
    torque_error_ += times(times(k, hit.depth + hit.depth_upper), reach);
  }
  force_lengths_ += upper_length(force);
  torque_lengths_ += upper_length(torque);
}

void WrenchSum::finish(Wrench& wrench) const {
  wrench.contacts = contacts_;
  wrench.undecided = undecided_;
  // The errors were summed with rounding too.
  const double rounding = (static_cast<double>(terms_) + 8) * kDoubleRoundoff;
  const double inflation = 1 + 4 * rounding;
  const double force_error = (force_error_ + rounding * force_lengths_) * inflation;
  const double torque_error = (torque_error_ + rounding * torque_lengths_) * inflation;
  if (!is_finite(force_) || !is_finite(torque_)) return;
  wrench.force = force_;
  wrench.torque = torque_;
  wrench.force_error = std::isnan(force_error) ? wrench.force_error : force_error;
  wrench.torque_error = std::isnan(torque_error) ? wrench.torque_error : torque_error;
}

}  // namespace planetree::query
