#pragma once

#include <cstdint>
#include <span>

#include "planetree/types.h"
#include "tests/oracle/brute_force.h"

/// Winding numbers by looking at every triangle, in ways that the library does
/// not go: solid angles, and rays in any direction but along an axis.
namespace planetree::oracle {

/// The winding number of triangles about a point, as a sum of solid angles in
/// long double (Van Oosterom & Strackee 1983): right to some 1e-15 of the
/// number of triangles, except within rounding of the surface.
long double solid_angle_winding(const Vec3& query, std::span<const Corners> triangles);

/// The side a point is on by the winding number of a watertight surface, found
/// without any error by signed crossings of a ray: long double where that is
/// certain, integers elsewhere. Never kUnknown.
Side exact_side(const Vec3& query, std::span<const Corners> triangles);

}  // namespace planetree::oracle
