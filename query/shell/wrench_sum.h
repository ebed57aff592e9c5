#pragma once

#include <cstddef>

#include "octree/geometry/rigid_transform.h"
#include "planetree/point_shell.h"
#include "query/shell/shell_memory.h"
#include "query/shell/shell_query.h"

namespace planetree::query {

/// Sums forces and torques, with a bound on what all errors may change.
///
/// Let k be the stiffness, d and d* the computed and the true depth of a point, D the bound on
/// |d - d*|, n its direction and r the vector from the reference to it. Computed directions err by
/// e of their length: by the pose, the point's normal and rounding.
///
/// - The force of a point errs by k D |n| + k (d + D) e, and by 3 u k d in two products.
/// - Its torque is k d (r x n). It errs by k D |r x n|, and by k (d + D) |r| times 2 e + 8 u: r
/// errs
///   by the pose too, and the cross product by 4 u |r|. |r| is rounded up.
/// - A sum of m vectors errs by m u of the sum of their lengths.
/// - If the direction is not known, the true force is any vector of length k (d + D) or less, so
/// that
///   the computed one errs by k (2 d + D).
class WrenchSum {
 public:
  WrenchSum(const SphereTree& tree, const ToolPlace& place, const ShellOptions& options);

  void add(const ShellHit& hit);
  /// Writes force, torque and their errors, contacts and undecided.
  void finish(Wrench& wrench) const;

 private:
  const SphereTree& tree_;
  const octree::RigidTransform& transform_;
  const ShellOptions& options_;
  double direction_error_ = 0;  // e
  Vec3 force_, torque_;
  double force_error_ = 0, torque_error_ = 0;
  double force_lengths_ = 0, torque_lengths_ = 0;  // sums of lengths
  std::size_t terms_ = 0, contacts_ = 0, undecided_ = 0;
};

}  // namespace planetree::query
