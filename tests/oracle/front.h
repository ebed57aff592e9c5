#pragma once

#include <span>

#include "planetree/types.h"
#include "tests/oracle/brute_force.h"

/// The side of a sheet that a point is on, by brute force: the nearest feature of all triangles
/// with 512 bits, then its pseudo-normal.
namespace planetree::oracle {

struct FrontAnswer {
  Side side = Side::kUnknown;
  /// Features that are equally near, up to 1e-14 of the squared distance, disagree; or the query is
  /// in the plane of the pseudo-normal up to 1e-13 of the distance, or the normals there cancel:
  /// then any side is right.
  bool is_ambiguous = false;
};

FrontAnswer front_side(const Vec3& query, std::span<const Corners> triangles);

}  // namespace planetree::oracle
