#pragma once

#include <array>
#include <span>
#include <vector>

#include "planetree/point_shell.h"
#include "tests/oracle/brute_force.h"
#include "tests/oracle/random.h"

/// The wrench of a point shell from every triangle: rotations in long double, distances by
/// exact_distance(), sides by winding numbers.
namespace planetree::oracle {

using Extended = std::array<long double, 3>;

struct WrenchTruth {
  std::vector<long double> depths;  ///< of each point
  Extended force{}, torque{};
  /// By how much `depths` may be off, since distances are taken at positions in double; and what
  /// that adds to force and torque, as lengths.
  long double depth_slack = 0, force_slack = 0, torque_slack = 0;
};

/// Computes a wrench by ForceDirection::kToolNormal. Sides are by SideRule::kSolid.
WrenchTruth wrench_truth(std::span<const Corners> triangles, bool is_watertight,
                         std::span<const ShellPoint> points, const Pose& pose,
                         const ShellOptions& options);

/// The length of the difference.
long double distance_between(const Vec3& a, const Extended& b);

/// Points all over a ball, with normals towards its centre.
std::vector<ShellPoint> ball_shell(Random& random, std::size_t count, double radius);

/// A random rotation of length 1, but for rounding.
Quaternion random_rotation(Random& random);

}  // namespace planetree::oracle
