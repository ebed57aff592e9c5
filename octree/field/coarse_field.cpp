#include "octree/field/coarse_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

// Farther from the grid, in its steps, squares say nothing of the grid, and might overflow.
constexpr double kMaxSteps = 0x1p40;

// Numbers of the corners of a cell. Corner 1 is next to corner 0 along x, corner 2 along y, corner
// 4 along z.
using Corners = Eigen::Array<float, 8, 1>;
using StoredCorners = Eigen::Array<std::int32_t, 8, 1>;

// Whether a corner is the upper one along an axis.
Corners upper_corners(unsigned axis) {
  Corners upper;
  if (axis == 0) upper << 0, 1, 0, 1, 0, 1, 0, 1;
  if (axis == 1) upper << 0, 0, 1, 1, 0, 0, 1, 1;
  if (axis == 2) upper << 0, 0, 0, 0, 1, 1, 1, 1;
  return upper;
}

// Trilinear interpolation between the corners of a cell: along z, then y, then x.
float interpolate(const Corners& value, const Eigen::Array3f& share) {
  const Eigen::Array4f along_z = value.head<4>() + share[2] * (value.tail<4>() - value.head<4>());
  const float low = along_z[0] + share[1] * (along_z[2] - along_z[0]);
  const float high = along_z[1] + share[1] * (along_z[3] - along_z[1]);
  return low + share[0] * (high - low);
}

}  // namespace

void CoarseField::fill(const FieldShape& shape, std::span<const FieldPoint> points,
                       bool has_strays) {
  shape_ = shape;
  points_ = points.empty() ? nullptr : points.data();
  has_strays_ = has_strays;
  if (is_empty()) return;
  steps_per_unit_ = 1 / shape.step;
  quanta_per_step_ = shape.step / shape.quantum;
  for (unsigned axis = 0; axis < 3; ++axis) last_[axis] = shape.size[axis] - 1;
}

// Lengths are in quanta.
FieldBounds CoarseField::bounds(const Point& query) const {
  FieldBounds found;
  if (is_empty()) return found;
  const Point steps = (query - shape_.lower) * steps_per_unit_;
  if (!(steps.cwiseAbs().maxCoeff() < kMaxSteps)) return found;
  const Point within = steps.cwiseMax(0.0).cwiseMin(last_);
  std::array<std::uint32_t, 3> at;
  Point share;
#pragma GCC unroll 3
  for (unsigned axis = 0; axis < 3; ++axis) {
    at[axis] = std::min(static_cast<std::uint32_t>(within[axis]), shape_.size[axis] - 2);
    share[axis] = within[axis] - at[axis];
  }
  std::array<const FieldPoint*, 4> rows;  // of two corners each
  for (unsigned row = 0; row < 4; ++row)
    rows[row] = points_ + shape_.index_of(at[0], at[1] + (row & 1), at[2] + (row >> 1));
  Corners square = Corners::Zero(), reach2 = Corners::Zero();
#pragma GCC unroll 3
  for (unsigned axis = 0; axis < 3; ++axis) {
    StoredCorners stored;
#pragma GCC unroll 8
    for (unsigned corner = 0; corner < 8; ++corner)
      stored[corner] = rows[corner >> 1][corner & 1][axis];
    const Corners surface = stored.cast<float>();
    const Corners corner_at = static_cast<float>(at[axis] * quanta_per_step_) +
                              upper_corners(axis) * static_cast<float>(quanta_per_step_);
    square += (corner_at - surface).square();
    reach2 += (static_cast<float>(steps[axis] * quanta_per_step_) - surface).square();
  }
  const auto mean = static_cast<double>(interpolate(square, share.cast<float>().array()));
  unsigned nearest = 0;
#pragma GCC unroll 8
  for (unsigned corner = 1; corner < 8; ++corner)
    nearest = reach2[corner] < reach2[nearest] ? corner : nearest;
  // The true distance of a corner is at least that of the stored point less the uncertainty u:
  // sum w (d - u)^2 >= m - 2 u sqrt(m), where m = sum w d^2.
  const double spread =
      quanta_per_step_ * quanta_per_step_ * (share.array() * (1 - share.array())).sum();
  const double rounding = kFieldRounding * static_cast<double>(square.maxCoeff());
  const double lower2 = mean - 2 * kFieldUncertainty * std::sqrt(mean) - spread - rounding;
  const double outside2 = ((steps - within) * quanta_per_step_).squaredNorm();
  if (!(outside2 > 0 && has_strays_))
    found.lower =
        std::sqrt(std::max(0.0, lower2) + outside2) * (1 - kFieldNormRounding) * shape_.quantum;
  found.upper =
      (std::sqrt(static_cast<double>(reach2[nearest])) * (1 + kFieldRounding) + kFieldUncertainty) *
      shape_.quantum;
  found.point = shape_.lower + shape_.surface_point(rows[nearest >> 1][nearest & 1]);
  return found;
}

CoarseField::Next CoarseField::next_to(const Point& steps) const {
  const Point within = (steps.array() + 0.5).max(0.0).min(last_.array());
  const FieldPoint& stored = points_[shape_.index_of(static_cast<std::uint32_t>(within[0]),
                                                     static_cast<std::uint32_t>(within[1]),
                                                     static_cast<std::uint32_t>(within[2]))];
  const double reach = (steps * quanta_per_step_ - Point(stored[0], stored[1], stored[2])).norm() *
                       (1 + kFieldNormRounding) * shape_.quantum;
  return {&stored, reach};
}

CoarseField::Estimate CoarseField::estimate(const Point& query) const {
  Estimate found;
  if (is_empty()) return found;
  const Point steps = (query - shape_.lower) * steps_per_unit_;
  if (!(steps.cwiseAbs().maxCoeff() < kMaxSteps)) return found;
  const double reach = next_to(steps).reach;
  found.upper = reach + shape_.uncertainty();
  found.lower = std::max(0.0, reach - shape_.step);
  found.width = shape_.step * shape_.step / (8 * (reach + shape_.step));
  return found;
}

FieldBounds CoarseField::upper_bound(const Point& query) const {
  FieldBounds found;
  if (is_empty()) return found;
  const Point steps = (query - shape_.lower) * steps_per_unit_;
  if (!(steps.cwiseAbs().maxCoeff() < kMaxSteps)) return found;
  const Next next = next_to(steps);
  found.upper = next.reach + shape_.uncertainty();
  found.point = shape_.lower + shape_.surface_point(*next.stored);
  return found;
}

}  // namespace planetree::octree
