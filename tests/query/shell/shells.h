#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "planetree/point_shell.h"

/// Shells, poses and wrenches for tests.
namespace planetree::query {

/// Points all over a ball of this radius, on a spiral from pole to pole, with normals towards its
/// centre.
inline std::vector<ShellPoint> ball_shell(std::size_t count, double radius) {
  std::vector<ShellPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const double z = 1 - 2 * share, turn = 2.399963229728653 * static_cast<double>(i);
    const double around = std::sqrt(1 - z * z);
    const Vec3 at{around * std::cos(turn), around * std::sin(turn), z};
    const double length = std::sqrt(at.x * at.x + at.y * at.y + at.z * at.z);
    points.push_back({{at.x * radius, at.y * radius, at.z * radius},
                      {-at.x / length, -at.y / length, -at.z / length}});
  }
  return points;
}

/// A rotation by an angle about an axis between x and z.
inline Quaternion turned_by(double angle) {
  return {std::cos(angle / 2), 0.6 * std::sin(angle / 2), 0, 0.8 * std::sin(angle / 2)};
}

/// Force, torque, errors and counts that do not depend on history, as bits.
inline std::vector<std::uint64_t> bits_of(const Wrench& wrench) {
  std::vector<std::uint64_t> bits;
  for (const double value :
       {wrench.force.x, wrench.force.y, wrench.force.z, wrench.torque.x, wrench.torque.y,
        wrench.torque.z, wrench.force_error, wrench.torque_error})
    bits.push_back(std::bit_cast<std::uint64_t>(value));
  bits.push_back(wrench.contacts);
  bits.push_back(wrench.undecided);
  bits.push_back(static_cast<std::uint64_t>(wrench.status));
  return bits;
}

}  // namespace planetree::query
